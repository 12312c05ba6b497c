use std::collections::{HashMap, HashSet};

use crate::components::{MaterialId, Mesh};
use crate::counts::{agreeing, counted};
use crate::document::{
    self, Diagnostic, GeneratedCrown, Map, Material, Obj, PartsBy, Ply, Ref, ScenePath,
    unknown_name,
};
use crate::placement::is_like;
use crate::systems::Resources;

/// Most parts to name in a message.
const MOST_SHOWN: usize = 10;

/// Material of each part of a mesh; a part without one is reported and gets the first material.
pub(in crate::systems) fn part_materials(
    mesh: &document::Prototype,
    loaded: &Mesh,
    path: &ScenePath,
    resources: &mut Resources,
) -> Vec<MaterialId> {
    let none = Map::new();
    let (named, rest) = match mesh {
        document::Prototype::Obj(obj) => (&obj.parts, obj.material.as_ref()),
        document::Prototype::Gltf(gltf) => (&gltf.parts, gltf.material.as_ref()),
        document::Prototype::Ply(Ply { material, .. })
        | document::Prototype::Discs { material, .. }
        | document::Prototype::Faces { material, .. } => (&none, Some(material)),
        document::Prototype::Crown(crown) => {
            return crown_materials(crown, loaded, path, resources);
        }
    };
    if let Some(error) = materials_for_parts(mesh, named, loaded, path) {
        resources.report(error);
        return vec![MaterialId(0); loaded.parts.len()];
    }
    check_part_names(named, loaded, path, resources);
    let patterns: Vec<_> = patterns(named);
    // Parts of one material are many: it is looked up once.
    let mut materials = Vec::new();
    let mut missing = Vec::new();
    let mut known: HashMap<&str, Option<MaterialId>> = HashMap::new();
    for part in &loaded.parts {
        let pattern = || patterns.iter().find(|(pattern, _)| is_like(pattern, &part.name));
        let (material, at) = match (named.get(&part.name), rest) {
            (Some(material), _) => (material, path.key("parts").name(&part.name)),
            (None, rest) => match (pattern(), rest) {
                (Some((pattern, material)), _) => (*material, path.key("parts").name(*pattern)),
                (None, Some(material)) => (material, path.key("material")),
                (None, None) => {
                    missing.push(part.name.as_str());
                    continue;
                }
            },
        };
        let id = if let Some(id) = known.get(material.as_str()) {
            *id
        } else {
            let id = resources.material(material, &at);
            known.insert(material, id);
            id
        };
        materials.extend(id);
    }
    if !missing.is_empty() {
        resources.report(missing_parts(mesh, &missing, path));
    }
    materials.resize(loaded.parts.len(), MaterialId(0));
    materials
}

/// Error of `parts` that names the materials of an OBJ file, whose parts are named by groups: `tree/bark`.
fn materials_for_parts(
    mesh: &document::Prototype,
    named: &Map<Ref<Material>>,
    loaded: &Mesh,
    path: &ScenePath,
) -> Option<Diagnostic> {
    let document::Prototype::Obj(Obj { parts_by: PartsBy::Group, .. }) = mesh else { return None };
    let parts = || loaded.parts.iter().map(|part| part.name.as_str());
    let materials: HashSet<&str> =
        parts().filter_map(|part| Some(part.rsplit_once('/')?.1)).collect();
    let is_material = |name: &String| materials.contains(name.as_str());
    if named.is_empty() || !named.keys().all(is_material) || parts().any(|p| named.contains_key(p))
    {
        return None;
    }
    let shown: Vec<_> = parts().take(MOST_SHOWN).map(|part| format!("`{part}`")).collect();
    let more = if loaded.parts.len() > MOST_SHOWN { ", .." } else { "" };
    let message = format!(
        "`parts` has names of materials (`usemtl`), and the parts of the file are groups: {}{more}",
        shown.join(", ")
    );
    let help = "write parts_by: Material, then `parts` names the materials of the file";
    Some(Diagnostic::error(path.key("parts"), message).help(help))
}

/// Refuses names in `parts` that no part of the mesh has.
fn check_part_names(
    named: &Map<Ref<Material>>,
    loaded: &Mesh,
    path: &ScenePath,
    resources: &mut Resources,
) {
    if named.is_empty() {
        return;
    }
    let known = || loaded.parts.iter().map(|part| part.name.as_str());
    let names: HashSet<&str> = known().collect();
    let is_known = |name: &str| {
        names.contains(name) || name.contains('*') && known().any(|part| is_like(name, part))
    };
    let unknown: Vec<&String> = named.keys().filter(|name| !is_known(name)).collect();
    for name in unknown.iter().take(MOST_SHOWN) {
        let at = path.key("parts").name(*name);
        let error = unknown_name(at, "part", name, known());
        let help = error.help.map(|help| help.replace("this scene defines", "its file has"));
        resources.report(Diagnostic { help, ..error });
    }
    if let Some(more) = unknown.len().checked_sub(MOST_SHOWN).filter(|more| *more > 0) {
        let message = format!(
            "{} in `parts` {} of no part",
            counted(more, "more name"),
            agreeing(more, "is the name", "are names")
        );
        resources.report(Diagnostic::error(path.key("parts"), message));
    }
}

/// Materials of the parts of a generated crown.
fn crown_materials(
    crown: &GeneratedCrown,
    loaded: &Mesh,
    path: &ScenePath,
    resources: &mut Resources,
) -> Vec<MaterialId> {
    let leaf = resources.material(&crown.leaf_material, &path.key("leaf_material"));
    let wood = crown.wood_material.as_deref();
    let wood = wood.and_then(|name| resources.material(name, &path.key("wood_material")));
    let of = |part: &str| if part == "leaf" { leaf } else { wood };
    // `document::check` asks for a wood material wherever there is wood.
    loaded.parts.iter().map(|part| of(&part.name).unwrap_or(MaterialId(0))).collect()
}

/// Names with `*` and their materials, those with most other letters first.
fn patterns(named: &Map<Ref<Material>>) -> Vec<(&str, &Ref<Material>)> {
    let letters = |pattern: &str| pattern.chars().filter(|&letter| letter != '*').count();
    let patterns = named.iter().filter(|(name, _)| name.contains('*'));
    let mut patterns: Vec<_> = patterns.map(|(name, material)| (name.as_str(), material)).collect();
    patterns.sort_by_key(|(pattern, _)| std::cmp::Reverse(letters(pattern)));
    patterns
}

fn missing_parts(mesh: &document::Prototype, missing: &[&str], path: &ScenePath) -> Diagnostic {
    let shown = missing.iter().take(MOST_SHOWN);
    let list = shown.clone().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ");
    let more = match missing.len() {
        count if count > MOST_SHOWN => format!(" and {} more", count - MOST_SHOWN),
        _ => String::new(),
    };
    let message = match missing.len() {
        1 => format!("part {list} has no material"),
        count => format!("{} have no material: {list}{more}", counted(count, "part")),
    };
    let entries = shown.map(|name| format!("{name:?}: \"..\"")).collect::<Vec<_>>().join(", ");
    let entries = if more.is_empty() { entries } else { format!("{entries}, ..") };
    let mut help = format!("write parts: {{ {entries} }}, or material: \"..\" for all others");
    if missing.len() > 1 {
        help += "; `*` in a name stands for any text, as in parts: { \"leaf*\": \"leaf\" }";
        if matches!(mesh, document::Prototype::Obj(Obj { parts_by: PartsBy::Group, .. })) {
            help +=
                ", and with parts_by: Material the parts are the materials (`usemtl`) of the file";
        }
    }
    Diagnostic::error(path, message).help(help)
}
