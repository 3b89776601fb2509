//! Memory layout of a struct, in the terms of Rust and of WGSL.

/// Field of a struct: its name, offset and type in Rust's terms, `[f32; 3]` for a vector.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct FieldLayout {
    pub(crate) name: String,
    pub(crate) offset: usize,
    pub(crate) type_name: String,
}

/// Memory layout of a struct in one of the two languages.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct StructLayout {
    pub(crate) name: String,
    pub(crate) size: usize,
    pub(crate) fields: Vec<FieldLayout>,
}

/// Type name of a field, without module paths.
pub(crate) fn type_name_of<Whole, F>(_field: fn(&Whole) -> &F) -> String {
    let full = std::any::type_name::<F>();
    let (bracket, path) = full.split_at(usize::from(full.starts_with('[')));
    format!("{bracket}{}", path.rsplit("::").next().unwrap_or(path))
}
