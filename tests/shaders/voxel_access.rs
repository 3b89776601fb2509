//! Check that one shader file alone fetches voxels, and one alone reads the tables of transfer functions.

use std::collections::BTreeSet;

use chiaroscuro_render::SHADERS;
use wgpu::TextureFormat;

use crate::sources::{entry_shaders, validate_shader, variants, without_comments};

/// File that alone fetches voxels.
const FIELD: &str = "volume/field.wgsl";

/// File that alone fetches voxels of pages.
const PAGES: &str = "volume/pages.wgsl";

/// File that alone reads the tables of transfer functions.
const MATERIAL: &str = "volume/material.wgsl";

/// Variables of [`FIELD`] that others use as well: size of the grid, and samplers.
const SHARED_VARIABLES: [&str; 4] = ["bound_grid", "grid", "clamped", "nearest"];

/// Names of [`MATERIAL`] by which tables are declared, and entries found in them.
const TABLE_NAMES: [&str; 5] = ["TransferTable", "TABLE_SIZE", "TableEntry", "table_entry", "nearest_entry"];

/// Variables that hold no voxels: three-dimensional textures that are read, with what other passes store of light, of
/// extinction, or of distances to cells.
const OTHER_TEXTURES: [&str; 27] = [
    "attenuation_0",
    "attenuation_1",
    "attenuation_2",
    "attenuation_3",
    "attenuation_4",
    "attenuation_5",
    "attenuation_6",
    "attenuation_7",
    "before",
    "blue",
    "bounced_texture",
    "distances",
    "extinction",
    "green",
    "light_distances",
    "medium",
    "normals",
    "opacity",
    "point_0",
    "point_1",
    "point_2",
    "point_3",
    "red",
    "sheets",
    "sky_map",
    "sky_texture",
    "transmittance",
];

/// Identifiers and numbers of a source, in order, without comments, imports and conditions.
fn tokens(text: &str) -> Vec<String> {
    let is_separator = |c: char| !(c.is_alphanumeric() || c == '_');
    let code = without_comments(text);
    let lines = code.lines().filter(|line| !line.starts_with('#'));
    lines
        .flat_map(|line| line.split(is_separator))
        .filter(|token| !token.is_empty())
        .map(str::to_owned)
        .collect()
}

/// Names of the variables that a source declares in its module.
fn module_variables(text: &str) -> BTreeSet<String> {
    let declared = |line: &str| {
        let code = line.split("//").next()?;
        let at = code.find("var ").or_else(|| code.find("var<"))?;
        let is_in_module = !line.starts_with(' ');
        let name = code[at..].split(':').next()?.split(' ').next_back()?;
        is_in_module.then(|| name.to_owned())
    };
    text.lines().filter_map(declared).collect()
}

fn text_of(name: &str) -> &'static str {
    SHADERS.iter().find(|(known, _)| *known == name).expect("the file is there").1
}

/// Names that only one file may use: the file, and the names.
fn reserved_names() -> [(&'static str, BTreeSet<String>); 3] {
    let mut fetched = module_variables(text_of(FIELD));
    fetched.retain(|name| !SHARED_VARIABLES.contains(&name.as_str()));
    let mut tables = module_variables(text_of(MATERIAL));
    tables.extend(TABLE_NAMES.map(str::to_owned));
    let mut paged = module_variables(text_of(PAGES));
    // The uniform of the levels holds no voxel.
    paged.retain(|name| name != "bound_pages" && name != "pages");
    [(FIELD, fetched), (MATERIAL, tables), (PAGES, paged)]
}

/// Names in a file that are reserved for another one.
fn foreign_names(file: &str, text: &str) -> Vec<String> {
    let others = reserved_names().into_iter().filter(|(owner, _)| *owner != file);
    let reserved: BTreeSet<_> = others.flat_map(|(_, names)| names).collect();
    tokens(text).into_iter().filter(|token| reserved.contains(token)).collect()
}

/// Three-dimensional textures read, and tables, that a shader declares beside those of the two files.
fn undeclared_access(source: &str) -> Vec<String> {
    let module = validate_shader(source).expect("the shader is valid");
    let known: BTreeSet<_> = reserved_names().into_iter().flat_map(|(_, names)| names).collect();
    let is_access = |variable: &naga::GlobalVariable| {
        let ty = &module.types[variable.ty];
        match ty.inner {
            naga::TypeInner::Image { dim, class: naga::ImageClass::Sampled { .. }, .. } => {
                dim == naga::ImageDimension::D3
            }
            _ => ty.name.as_deref() == Some("TransferTable"),
        }
    };
    let accessed = module.global_variables.iter().filter(|(_, variable)| is_access(variable));
    let names = accessed.filter_map(|(_, variable)| variable.name.clone());
    names.filter(|name| !known.contains(name) && !OTHER_TEXTURES.contains(&name.as_str())).collect()
}

#[test]
fn only_the_field_fetches_voxels_and_only_the_material_reads_tables() {
    let [(_, fetched), (_, tables), (_, paged)] = reserved_names();
    for name in ["density_texture", "pyramid_texture", "source_texture", "gradients", "voxels"] {
        assert!(fetched.contains(name), "{name} holds voxels: {fetched:?}");
    }
    assert!(paged.contains("page_pool") && paged.contains("page_table"), "pages hold voxels: {paged:?}");
    for name in ["table", "lighting_table", "look_table"] {
        assert!(tables.contains(name), "{name} is a table: {tables:?}");
    }
    let found: Vec<_> = SHADERS
        .iter()
        .map(|(file, text)| (*file, foreign_names(file, text)))
        .filter(|(_, names)| !names.is_empty())
        .collect();
    assert!(found.is_empty(), "{FIELD} fetches voxels, {MATERIAL} reads tables: {found:?}");
}

#[test]
fn no_shader_declares_other_textures_of_voxels() {
    for name in entry_shaders() {
        for (what, source) in variants(name, TextureFormat::R16Float, TextureFormat::R16Float) {
            let found = undeclared_access(&source);
            assert!(found.is_empty(), "{name}, {what}: {found:?} belong in {FIELD} or {MATERIAL}");
        }
    }
}

#[test]
fn access_from_other_files_is_noticed() {
    let file = "light/march.wgsl";
    let text = text_of(file);
    assert!(foreign_names(file, text).is_empty());
    for (line, name) in [
        ("let d = textureSampleLevel(density_texture, clamped, p, 0.0).r;", "density_texture"),
        ("let d = textureLoad(pyramid_texture, vec3i(0), 0);", "pyramid_texture"),
        ("let pair = unpack2x16unorm(voxels[0]);", "voxels"),
        ("let share = table.entries[3].a;", "table"),
        ("let low = table_entry(density).low;", "table_entry"),
    ] {
        let wrong = format!("{text}\nfn wrong() {{\n    {line}\n}}\n");
        assert_eq!(foreign_names(file, &wrong), [name], "{line}");
        assert!(foreign_names(file, &format!("{text}\n// {line}\n")).is_empty(), "comments may name {name}");
    }
    let source = &variants(file, TextureFormat::R16Float, TextureFormat::R16Float)[0].1;
    assert!(undeclared_access(source).is_empty());
    for (declaration, name) in [
        ("@group(3) @binding(0) var more_voxels: texture_3d<f32>;", "more_voxels"),
        ("@group(3) @binding(0) var labels: texture_3d<u32>;", "labels"),
        ("@group(3) @binding(0) var<storage, read> more: TransferTable;", "more"),
    ] {
        assert_eq!(undeclared_access(&format!("{source}\n{declaration}\n")), [name]);
    }
}
