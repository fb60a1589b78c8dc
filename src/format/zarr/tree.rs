//! What is in a store: groups and arrays by path, from consolidated metadata or from the folders.

use super::array::Array;
use super::json::{self, Object, child, text, wrong};
use super::store::Store;
use super::{ZARR, v2, v3};
use crate::format::problem::{at, invalid, missing};
use crate::volume::{Limits, Problem, ReadError};
use serde_json::Value;
use std::collections::BTreeMap;
use std::path::{Component, Path};

/// One group or array.
#[derive(Debug)]
pub(super) struct Node {
    pub is_array: bool,
    metadata: Object,
    pub attributes: Object,
    version: u8,
}

/// All of them by path; the store itself has the empty one.
#[derive(Debug)]
pub(super) struct Tree {
    pub nodes: BTreeMap<String, Node>,
}

/// Files that make a folder one of Zarr.
const MARKS: [&str; 5] = ["zarr.json", ".zgroup", ".zarray", ".zmetadata", ".zattrs"];

/// True for a folder with the metadata of a group or an array in it.
pub(super) fn is_zarr(folder: &Path) -> bool {
    MARKS.iter().any(|name| folder.join(name).is_file())
}

/// How deep groups may lie in groups.
const DEEPEST: usize = 8;

impl Tree {
    pub(super) fn read(store: &Store, limits: &Limits) -> Result<Self, ReadError> {
        let mut tree = Self {
            nodes: BTreeMap::new(),
        };
        if !tree.add_consolidated(store, limits)? {
            let mut folders = 0;
            tree.add_folder(store, "", DEEPEST, &mut folders, limits)?;
        }
        let here = at(store.path());
        match tree.nodes.is_empty() {
            true => Err(here(missing(ZARR, "zarr.json` or `.zgroup` or `.zarray"))),
            false => Ok(tree),
        }
    }

    /// The array at a path.
    pub(super) fn array(&self, path: &str, limits: &Limits) -> Result<Array, Problem> {
        let node = self.nodes.get(path).filter(|node| node.is_array);
        let Some(node) = node else {
            return Err(invalid(ZARR, "path", "an array of the store", path));
        };
        match node.version {
            2 => v2::array(path, &node.metadata, node.attributes.clone(), limits),
            _ => v3::array(path, &node.metadata, limits),
        }
    }

    /// Takes all nodes out of one file, where there is one; false where there is none.
    fn add_consolidated(&mut self, store: &Store, limits: &Limits) -> Result<bool, ReadError> {
        let read = |key: &str| -> Result<Option<Object>, ReadError> {
            let bytes = store.text(key, limits)?;
            let object = bytes.map(|bytes| json::object(&bytes)).transpose();
            object.map_err(at(&store.shown(key)))
        };
        if let Some(root) = read("zarr.json")? {
            let here = store.shown("zarr.json");
            let consolidated = child(&root, "consolidated_metadata").map_err(at(&here))?;
            let inside = child(&consolidated, "metadata").map_err(at(&here))?;
            if inside.is_empty() {
                return Ok(false);
            }
            self.add_v3("", root).map_err(at(&here))?;
            for (path, metadata) in inside {
                let metadata = as_object(&path, metadata).map_err(at(&here))?;
                self.add_v3(&path, metadata).map_err(at(&here))?;
            }
            return Ok(true);
        }
        let Some(root) = read(".zmetadata")? else {
            return Ok(false);
        };
        let here = store.shown(".zmetadata");
        let inside = child(&root, "metadata").map_err(at(&here))?;
        for (key, metadata) in &inside {
            let (path, name) = key.rsplit_once('/').unwrap_or(("", key));
            if !matches!(name, ".zarray" | ".zgroup") {
                continue;
            }
            let attributes = match path {
                "" => ".zattrs".to_owned(),
                _ => format!("{path}/.zattrs"),
            };
            let attributes = inside.get(&attributes).cloned();
            let attributes = attributes.unwrap_or_else(|| Value::Object(Object::new()));
            let node = Node {
                is_array: name == ".zarray",
                metadata: as_object(key, metadata.clone()).map_err(at(&here))?,
                attributes: as_object(path, attributes).map_err(at(&here))?,
                version: 2,
            };
            self.add(path, node).map_err(at(&here))?;
        }
        Ok(true)
    }

    /// Adds what the folder `path` is, and what lies in it where it is no array.
    fn add_folder(
        &mut self,
        store: &Store,
        path: &str,
        deeper: usize,
        folders: &mut usize,
        limits: &Limits,
    ) -> Result<(), ReadError> {
        let inside = |name: &str| match path {
            "" => name.to_owned(),
            _ => format!("{path}/{name}"),
        };
        let read = |name: &str| -> Result<Option<Object>, ReadError> {
            let key = inside(name);
            let bytes = store.text(&key, limits)?;
            let object = bytes.map(|bytes| json::object(&bytes)).transpose();
            object.map_err(at(&store.shown(&key)))
        };
        let mut is_array = false;
        let here = store.shown(path);
        if let Some(metadata) = read("zarr.json")? {
            is_array = self.add_v3(path, metadata).map_err(at(&here))?;
        } else {
            let array = read(".zarray")?;
            is_array |= array.is_some();
            let metadata = match array {
                Some(array) => Some(array),
                None => read(".zgroup")?,
            };
            let attributes = read(".zattrs")?;
            if metadata.is_some() || attributes.is_some() {
                let node = Node {
                    is_array,
                    metadata: metadata.unwrap_or_default(),
                    attributes: attributes.unwrap_or_default(),
                    version: 2,
                };
                self.add(path, node).map_err(at(&here))?;
            }
        }
        if is_array || deeper == 0 {
            return Ok(());
        }
        for name in store.folders(path, limits.max_files) {
            *folders = folders.saturating_add(1);
            if *folders > limits.max_files {
                let wanted = format!("at most {} folders", limits.max_files);
                return Err(at(&here)(invalid(ZARR, "folder", wanted, &name)));
            }
            self.add_folder(
                store,
                &inside(&name),
                deeper.saturating_sub(1),
                folders,
                limits,
            )?;
        }
        Ok(())
    }

    /// Adds what a `zarr.json` describes; true for an array.
    fn add_v3(&mut self, path: &str, metadata: Object) -> Result<bool, Problem> {
        let is_array = match text(&metadata, "node_type")? {
            "array" => true,
            "group" => false,
            _ => {
                let found = json::required(&metadata, "node_type")?;
                return Err(wrong("node_type", "array or group", found));
            }
        };
        let node = Node {
            is_array,
            attributes: child(&metadata, "attributes")?,
            metadata,
            version: 3,
        };
        self.add(path, node).map(|()| is_array)
    }

    fn add(&mut self, path: &str, node: Node) -> Result<(), Problem> {
        let is_plain = path.chars().all(|c| !c.is_control())
            && Path::new(path)
                .components()
                .all(|part| matches!(part, Component::Normal(_)));
        if !is_plain {
            let wanted = "the path of a node in the Zarr folder";
            return Err(invalid(ZARR, "path", wanted, path));
        }
        self.nodes.insert(path.to_owned(), node);
        Ok(())
    }
}

fn as_object(field: &str, value: Value) -> Result<Object, Problem> {
    match value {
        Value::Object(object) => Ok(object),
        other => Err(wrong(field, "a JSON object", &other)),
    }
}
