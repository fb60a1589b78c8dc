//! Compiles `shaders/*.wgsl` to SPIR-V and writes what Rust must know about them.
//!
//! Every file directly under `shaders/` is one entry point called `main`. A line `#import name` stands
//! for `shaders/lib/name.wgsl`, each file once. In a name, `{slot}` is replaced by each word that
//! [`variants::ENTRIES`] gives for that slot, `{slot=word}` by that word where it gives none: every combination of
//! words is a variant. Words of a slot that is a constant are in one module, and a specialization constant chooses
//! (`shaders/alternatives.rs`, `shaders/constants.rs`); words of others make modules of their own.
//!
//! Written to `OUT_DIR`: `shaders.deflate` (the words of all modules, each compressed by itself), `shaders.rs` (the
//! table of modules with their bindings, a `#[repr(C)]` struct for each uniform, and the constants) and
//! `blue_noise.bin` (the pattern of jittered rays); with the feature `conformance` `wgsl.rs` too (the texts of all files).

#[path = "shaders/alternatives.rs"]
mod alternatives;
#[path = "shaders/blue_noise.rs"]
mod blue_noise;
#[path = "shaders/compose.rs"]
#[allow(
    dead_code,
    reason = "dumps of conformance cases put single variants together"
)]
mod compose;
#[path = "shaders/constants.rs"]
mod constants;
#[path = "shaders/dynamic_indexing.rs"]
mod dynamic_indexing;
#[path = "shaders/flat_varyings.rs"]
mod flat_varyings;
#[path = "shaders/no_contraction.rs"]
mod no_contraction;
#[path = "shaders/opaque_predicates.rs"]
mod opaque_predicates;
#[path = "shaders/point_size.rs"]
mod point_size;
#[path = "shaders/read_once.rs"]
mod read_once;
#[path = "shaders/short_circuit.rs"]
mod short_circuit;
#[path = "shaders/uniform_loads.rs"]
mod uniform_loads;
#[path = "shaders/variants.rs"]
mod variants;

use compose::{Source, combinations, fills};
use naga::valid::{Capabilities, ValidationFlags, Validator};
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::{env, fs};
use variants::{ENTRIES, PROBES, Slot};

fn main() {
    let out = PathBuf::from(env::var_os("OUT_DIR").expect("cargo sets OUT_DIR"));
    println!("cargo:rerun-if-changed=build.rs");
    println!("cargo:rerun-if-changed=shaders");
    let mut book = Book::default();
    println!("cargo:rerun-if-env-changed=CARGO_FEATURE_CONFORMANCE");
    let probes = match env::var_os("CARGO_FEATURE_CONFORMANCE") {
        Some(_) => {
            fs::write(out.join("wgsl.rs"), texts()).expect("OUT_DIR can be written");
            PROBES
        }
        None => &[],
    };
    for (file, slots) in ENTRIES.iter().chain(probes) {
        book.add_all(file, slots);
    }
    say_packaged_commit();
    fs::write(out.join("shaders.deflate"), &book.stored).expect("OUT_DIR can be written");
    fs::write(out.join("shaders.rs"), book.rust()).expect("OUT_DIR can be written");
    let ranks = blue_noise::ranks().into_iter();
    let ranks = ranks.flat_map(|rank| (rank as u16).to_le_bytes());
    let ranks: Vec<u8> = ranks.collect();
    fs::write(out.join("blue_noise.bin"), ranks).expect("OUT_DIR can be written");
}

/// A package of cargo's says which commit it was made of: the program says so too. In a repository there is no such
/// file, and nothing here runs again for a new commit: there `STRATAVOX_COMMIT` says it (`src/main.rs`).
fn say_packaged_commit() {
    const FILE: &str = ".cargo_vcs_info.json";
    let Ok(text) = fs::read_to_string(FILE) else {
        return;
    };
    println!("cargo:rerun-if-changed={FILE}");
    let commit = text
        .split("\"sha1\"")
        .nth(1)
        .and_then(|rest| rest.split('"').nth(1));
    let dirty = match text.contains("\"dirty\": true") {
        true => "-dirty",
        false => "",
    };
    if let Some(commit) = commit {
        println!("cargo:rustc-env=STRATAVOX_PACKAGED_COMMIT={commit}{dirty}");
    }
}

/// The best of `miniz_oxide`.
const COMPRESSION: u8 = 10;

/// What has been compiled so far.
#[derive(Default)]
struct Book {
    stored: Vec<u8>,
    /// Where each module lies in it.
    modules: Vec<Range<usize>>,
    /// The text of the bindings of each.
    bindings: Vec<String>,
    /// One line of the Rust table for each variant, by name.
    table: BTreeMap<String, String>,
    /// Rust text of each uniform struct, by name.
    structs: BTreeMap<String, String>,
    constants: BTreeMap<String, String>,
}

impl Book {
    /// All variants of an entry: modules of those that constants choose among.
    fn add_all(&mut self, file: &str, slots: &[Slot]) {
        let mut modules: BTreeMap<Vec<&str>, Module> = BTreeMap::new();
        for words in combinations(slots) {
            let parted = slots.iter().zip(&words);
            let own = parted.filter(|(slot, _)| !slot.is_constant);
            let own: Vec<&str> = own.map(|(_, word)| *word).collect();
            let name = compose::name(file, &words);
            let module = modules
                .entry(own)
                .or_insert_with(|| self.add(file, &name, slots, &words));
            let values = module.values(slots, &words);
            let line = format!(
                "Shader {{ name: {name:?}, constants: &{values:?}, {} }}",
                module.text
            );
            assert!(
                self.table.insert(name.clone(), line).is_none(),
                "{name} stands twice in ENTRIES"
            );
        }
    }

    /// The module of a variant and of all those that differ from it by constants.
    fn add(&mut self, file: &str, name: &str, slots: &[Slot], words: &[&str]) -> Module {
        let fills = fills(slots, words);
        let chosen: Vec<Slot> = slots
            .iter()
            .filter(|slot| slot.is_constant)
            .copied()
            .collect();
        let source = alternatives::merged(file, &chosen, &fills, &read);
        let mut module = naga::front::wgsl::parse_str(&source.text).unwrap_or_else(|e| {
            let picture = e.emit_to_string(&source.text);
            fail(&source, name, e.location(&source.text), &picture)
        });
        constants::mark(&mut module);
        // No capability beyond the core: a shader that needs more is a build error.
        let check = |module: &naga::Module, flags| {
            Validator::new(flags, Capabilities::empty())
                .validate(module)
                .unwrap_or_else(|e| {
                    let picture = e.emit_to_string(&source.text);
                    fail(&source, name, e.location(&source.text), &picture)
                })
        };
        check(&module, ValidationFlags::all());
        if !is_probe(file) {
            short_circuit::evaluate_both_operands(&mut module);
            opaque_predicates::hide_branches(&mut module);
        }
        point_size::name_point_size(&mut module);
        if let Some(&of @ ("planes" | "stack")) = fills.get("parameters") {
            flat_varyings::hand_over(&mut module, of);
        }
        dynamic_indexing::index_by_selects(&mut module);
        read_once::read_parameters_once(&mut module);
        // What was uniform is so still, which nobody can know any longer.
        let uniformity = ValidationFlags::CONTROL_FLOW_UNIFORMITY;
        let info = check(&module, ValidationFlags::all().difference(uniformity));

        let (words, ids) = constants::specialized(&spirv(&module, &info, file));
        let software = alternatives::id_of("software") as u32;
        let words = uniform_loads::read_directly(software, &words);
        let bytes: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()).collect();
        let first = self.stored.len();
        self.stored
            .extend(miniz_oxide::deflate::compress_to_vec(&bytes, COMPRESSION));
        let number = self.modules.len();
        self.modules.push(first..self.stored.len());
        for (name, text) in uniform_structs(&module) {
            let known = self
                .structs
                .entry(name.clone())
                .or_insert_with(|| text.clone());
            assert!(*known == text, "struct {name} has two layouts");
        }
        self.constants.extend(named_constants(&module));
        let text = format!(
            "stage: {}, code: Code::Stored({number}), bindings: BINDINGS_{number}",
            stage(&module),
        );
        self.bindings.push(bindings(&module));
        Module { text, ids }
    }

    fn rust(&self) -> String {
        let mut text = String::new();
        for constant in self.constants.values() {
            writeln!(text, "{constant}").unwrap();
        }
        for definition in self.structs.values() {
            writeln!(text, "{definition}").unwrap();
        }
        let modules = &self.modules;
        writeln!(text, "/// Where the words of each module are stored.\nconst MODULES: &[Range<usize>] = &{modules:?};").unwrap();
        for (number, bindings) in self.bindings.iter().enumerate() {
            writeln!(
                text,
                "const BINDINGS_{number}: &[BindingSlot] = &[{bindings}];"
            )
            .unwrap();
        }
        writeln!(text, "const TABLE: &[Shader] = &[").unwrap();
        for line in self.table.values() {
            writeln!(text, "    {line},").unwrap();
        }
        writeln!(text, "];").unwrap();
        text
    }
}

/// A module that is written.
struct Module {
    /// What all of its variants have alike in the table.
    text: String,
    /// `SpecId` of each constant that the module has.
    ids: Vec<u32>,
}

impl Module {
    /// `SpecId` and value of each constant, for these words of the slots.
    fn values(&self, slots: &[Slot], words: &[&str]) -> Vec<(u32, u32)> {
        let chosen = slots.iter().zip(words).filter(|(slot, _)| slot.is_constant);
        let value = |(slot, word): (&Slot, &&str)| {
            let value = slot.words.iter().position(|one| one == word);
            (
                alternatives::id_of(slot.name) as u32,
                value.expect("a word of the slot") as u32,
            )
        };
        let values = chosen.map(value);
        values.filter(|(id, _)| self.ids.contains(id)).collect()
    }
}

/// The text of a file under `shaders`.
fn read(path: &str) -> String {
    let path = Path::new("shaders").join(path);
    fs::read_to_string(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()))
}

/// Stops the build with naga's picture and the place in the file that a person edits.
fn fail<T>(
    source: &Source,
    variant: &str,
    location: Option<naga::SourceLocation>,
    picture: &str,
) -> T {
    let place = location
        .and_then(|l| source.lines.get(l.line_number as usize - 1))
        .map_or_else(String::new, |(path, line)| {
            format!("shaders/{path}:{line}: ")
        });
    panic!("{place}in variant {variant}\n{picture}");
}

/// The texts of all files, for dumps of conformance cases: where each lies, under `shaders`, and what stands in it.
fn texts() -> String {
    let mut text = "/// The files of all shaders.\nconst FILES: &[(&str, &str)] = &[\n".to_owned();
    for folder in ["", "lib/", "probe/"] {
        let found = fs::read_dir(Path::new("shaders").join(folder)).expect("a folder of shaders");
        let mut names: Vec<String> = found
            .map(|entry| entry.expect("a file").file_name().to_string_lossy().into())
            .filter(|name: &String| name.ends_with(".wgsl"))
            .collect();
        names.sort();
        for name in names {
            let path = format!("{folder}{name}");
            writeln!(
                text,
                "    ({path:?}, include_str!(concat!(env!(\"CARGO_MANIFEST_DIR\"), \"/shaders/{path}\"))),"
            )
            .unwrap();
        }
    }
    text + "];\n"
}

/// Whether it is a shader of conformance, which is to see what a device makes of it as it stands.
fn is_probe(file: &str) -> bool {
    file.starts_with("probe/")
}

fn spirv(module: &naga::Module, info: &naga::valid::ModuleInfo, file: &str) -> Vec<u32> {
    use naga::back::spv;
    let options = spv::Options {
        lang_version: (1, 5),
        // The default also flips y and clamps depth, which is not Vulkan's way.
        flags: spv::WriterFlags::LABEL_VARYINGS,
        // Group is set and binding is binding, unchanged.
        fake_missing_bindings: true,
        capabilities: Some(
            [spirv::Capability::Shader, spirv::Capability::ImageQuery]
                .into_iter()
                .collect(),
        ),
        zero_initialize_workgroup_memory: spv::ZeroInitializeWorkgroupMemoryMode::None,
        // Our loops are bounded by construction: counters would only cost.
        force_loop_bounding: false,
        emit_int_div_checks: false,
        use_storage_input_output_16: false,
        ..Default::default()
    };
    let entry = spv::PipelineOptions {
        shader_stage: module.entry_points[0].stage,
        entry_point: "main".into(),
    };
    let words = spv::write_vec(module, info, &options, Some(&entry));
    let words = words.expect("a valid module can be written");
    match is_probe(file) {
        true => words,
        false => no_contraction::forbid_contraction(&words),
    }
}

fn stage(module: &naga::Module) -> String {
    let [entry] = &module.entry_points[..] else {
        panic!("an entry file has one entry point")
    };
    match entry.stage {
        naga::ShaderStage::Compute => {
            format!("Stage::Compute {{ workgroup: {:?} }}", entry.workgroup_size)
        }
        naga::ShaderStage::Vertex => "Stage::Vertex".into(),
        naga::ShaderStage::Fragment => "Stage::Fragment".into(),
        other => panic!("{other:?} shaders are not used"),
    }
}

/// The Rust text of a module's bindings, by ascending number.
fn bindings(module: &naga::Module) -> String {
    use naga::{AddressSpace, ImageClass, TypeInner};
    let mut slots = BTreeMap::new();
    for (_, variable) in module.global_variables.iter() {
        let Some(place) = variable.binding else {
            continue;
        };
        assert_eq!(place.group, 0, "all bindings are in group 0");
        let kind = match (variable.space, &module.types[variable.ty].inner) {
            (AddressSpace::Uniform, TypeInner::Struct { span, .. }) => format!("Uniform({span})"),
            // A struct around the array, so that the validation layers can follow the access.
            (AddressSpace::Storage { .. }, TypeInner::Struct { .. }) => "Storage".into(),
            (
                _,
                TypeInner::Image {
                    class: ImageClass::Storage { .. },
                    ..
                },
            ) => "StorageImage".into(),
            (_, TypeInner::Image { .. }) => "Texture".into(),
            (_, TypeInner::Sampler { .. }) => "Sampler".into(),
            other => panic!(
                "binding {:?} is of a kind that we do not use: {other:?}",
                variable.name
            ),
        };
        let name = variable.name.as_deref().expect("a global has a name");
        slots.insert(
            place.binding,
            format!(
                "BindingSlot {{ name: {name:?}, binding: {}, kind: BindingKind::{kind} }}",
                place.binding
            ),
        );
    }
    slots.into_values().collect::<Vec<_>>().join(", ")
}

/// Whole and float constants that a file gives as plain literals; specialization constants have no number of their own.
fn named_constants(module: &naga::Module) -> Vec<(String, String)> {
    let literal = |(_, constant): (_, &naga::Constant)| {
        let name = constant.name.clone()?;
        let naga::Expression::Literal(value) = module.global_expressions[constant.init] else {
            return None;
        };
        let (kind, value) = match value {
            naga::Literal::U32(v) if constants::id_of_mark(v).is_some() => return None,
            naga::Literal::U32(v) => ("u32", v.to_string()),
            naga::Literal::I32(v) => ("i32", v.to_string()),
            naga::Literal::F32(v) => ("f32", format!("{v:?}")),
            _ => return None,
        };
        let text =
            format!("/// The shaders' constant of that name.\npub const {name}: {kind} = {value};");
        Some((name, text))
    };
    module.constants.iter().filter_map(literal).collect()
}

/// `#[repr(C)]` CPU references of the uniform structs. Padding is private and made by `new`, so a field added in
/// WGSL is a compile error wherever the struct is filled.
fn uniform_structs(module: &naga::Module) -> Vec<(String, String)> {
    let uniforms = module
        .global_variables
        .iter()
        .filter(|(_, variable)| variable.space == naga::AddressSpace::Uniform);
    uniforms
        .map(|(_, variable)| rust_struct(module, variable.ty))
        .collect()
}

fn rust_struct(module: &naga::Module, handle: naga::Handle<naga::Type>) -> (String, String) {
    let ty = &module.types[handle];
    let naga::TypeInner::Struct { members, span } = &ty.inner else {
        panic!("a uniform is a struct")
    };
    let name = ty.name.clone().expect("a struct has a name");
    let (mut fields, mut asserts, mut padding) = (String::new(), String::new(), String::new());
    let (mut end, mut pads) = (0, 0);
    let mut pad_to = |fields: &mut String, offset: u32, end: u32| {
        if offset > end {
            writeln!(fields, "    pad{pads}: [u8; {}],", offset - end).unwrap();
            writeln!(padding, "            pad{pads}: [0; {}],", offset - end).unwrap();
            pads += 1;
        }
    };
    let mut names = Vec::new();
    for member in members {
        let field = member.name.clone().expect("a field has a name");
        pad_to(&mut fields, member.offset, end);
        let (rust, size) = rust_type(module, member.ty);
        writeln!(
            fields,
            "    /// See `shaders/lib`.\n    pub {field}: {rust},"
        )
        .unwrap();
        writeln!(
            asserts,
            "    assert!(std::mem::offset_of!({name}, {field}) == {});",
            member.offset
        )
        .unwrap();
        end = member.offset + size;
        names.push((field, rust));
    }
    pad_to(&mut fields, *span, end);
    // A plain-old-data CPU reference without padding: what a host fills.
    let public: String = names
        .iter()
        .map(|(f, t)| format!("    /// See `shaders/lib`.\n    pub {f}: {t},\n"))
        .collect();
    let copies: String = names
        .iter()
        .map(|(f, _)| format!("            {f}: fields.{f},\n"))
        .collect();
    let text = format!(
        "/// Uniform `{name}` of the shaders, byte for byte.\n#[repr(C)]\n\
         #[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]\npub struct {name} {{\n{fields}}}\n\
         /// The fields of [`{name}`]: filled by name, none can be forgotten.\n\
         #[derive(Clone, Copy, Debug, PartialEq, bytemuck::Zeroable)]\npub struct {name}Fields {{\n{public}}}\n\
         impl From<{name}Fields> for {name} {{\n    fn from(fields: {name}Fields) -> Self {{\n        Self {{\n{copies}{padding}        }}\n    }}\n}}\n\
         const _: () = {{\n{asserts}    assert!(std::mem::size_of::<{name}>() == {span});\n}};"
    );
    (name, text)
}

/// Rust type and its size. Vectors are arrays; a matrix is an array of its columns.
fn rust_type(module: &naga::Module, handle: naga::Handle<naga::Type>) -> (String, u32) {
    use naga::{ArraySize, ScalarKind, TypeInner};
    let scalar = |scalar: naga::Scalar| match (scalar.kind, scalar.width) {
        (ScalarKind::Float, 4) => "f32",
        (ScalarKind::Uint, 4) => "u32",
        (ScalarKind::Sint, 4) => "i32",
        other => panic!("uniform fields have four bytes, not {other:?}"),
    };
    match module.types[handle].inner {
        TypeInner::Scalar(s) => (scalar(s).into(), 4),
        TypeInner::Vector { size, scalar: s } => {
            (format!("[{}; {}]", scalar(s), size as u32), size as u32 * 4)
        }
        TypeInner::Matrix {
            columns,
            rows: naga::VectorSize::Quad,
            scalar: s,
        } => (
            format!("[[{}; 4]; {}]", scalar(s), columns as u32),
            columns as u32 * 16,
        ),
        TypeInner::Array {
            base,
            size: ArraySize::Constant(count),
            stride,
        } => {
            let (element, size) = rust_type(module, base);
            assert_eq!(
                size, stride,
                "array elements of a uniform fill their stride"
            );
            (format!("[{element}; {count}]"), stride * count.get())
        }
        ref other => panic!("uniform fields are numbers, not {other:?}"),
    }
}
