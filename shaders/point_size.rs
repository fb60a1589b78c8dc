//! The size of points, which WGSL has no word for: the output of a vertex at a location of its own becomes it.

use naga::{Binding, BuiltIn, Module, TypeInner};

/// Where shaders put it.
const LOCATION: u32 = 31;

/// Makes it the size of points.
pub fn name_point_size(module: &mut Module) {
    let changed: Vec<_> = module
        .types
        .iter()
        .filter_map(|(handle, ty)| {
            let mut ty = ty.clone();
            let TypeInner::Struct { members, .. } = &mut ty.inner else {
                return None;
            };
            let is_size = |binding: &Option<Binding>| {
                matches!(
                    binding,
                    Some(Binding::Location {
                        location: LOCATION,
                        ..
                    })
                )
            };
            let size = members.iter_mut().find(|member| is_size(&member.binding))?;
            size.binding = Some(Binding::BuiltIn(BuiltIn::PointSize));
            Some((handle, ty))
        })
        .collect();
    for (handle, ty) in changed {
        module.types.replace(handle, ty);
    }
}
