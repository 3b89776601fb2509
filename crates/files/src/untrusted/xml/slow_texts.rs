//! Families of XML texts that take a parser long, for tests of every reader of XML.

/// Makes a root with `count` namespaces, and as many children that each declare one more: cubic in the parser.
pub fn nested_namespaces(name: &str, count: usize) -> String {
    let declared = (0..count).map(|at| format!(" xmlns:a{at}=\"u{at}\"")).collect::<Vec<String>>().concat();
    format!("<{name}{declared}>{}</{name}>", "<x xmlns:q=\"z\"/>".repeat(count))
}

/// Makes one element with `count` attributes: quadratic in the parser.
pub fn many_attributes(name: &str, count: usize) -> String {
    let attributes = (0..count).map(|at| format!(" a{at}=\"\"")).collect::<Vec<String>>().concat();
    format!("<{name}{attributes}/>")
}

/// Texts of less than a megabyte for which the parser alone takes from 9 s to hours, each with a fragment of the
/// expected error. The root element is called `root`.
pub fn slow_texts(root: &str) -> Vec<(&'static str, String)> {
    let namespaces = nested_namespaces(root, 8000);
    let attributes = many_attributes(root, 60_000);
    // Attributes with a prefix, whose namespace has a long URI.
    let prefixed = (0..4000).map(|at| format!(" p:a{at}=\"\"")).collect::<Vec<String>>().concat();
    let prefixed = format!("<{root} xmlns:p=\"{}\"{prefixed}/>", "u".repeat(600_000));
    // Long names that differ in their last character.
    let long = (0..4000)
        .map(|at| format!(" {}{}=\"\"", "n".repeat(200), char::from_u32(0x4e00 + at).unwrap_or_default()))
        .collect::<Vec<String>>()
        .concat();
    let deep = format!("<{root}>{}{}</{root}>", "<a>".repeat(100_000), "</a>".repeat(100_000));
    // Each level copies the namespaces of all outer levels.
    let stair = (0..250).map(|at| format!("<a xmlns:b{at}=\"u\">")).collect::<Vec<String>>().concat();
    let stairs = format!("<{root}>{}{}</{root}>", stair, "<x xmlns:q=\"z\"/>".repeat(10_000));
    vec![
        ("8000 namespaces", namespaces),
        ("60000 attributes", attributes),
        ("4000 attributes", prefixed),
        ("4000 attributes", format!("<{root}{long}/>")),
        ("nested more than 256 deep", deep),
        ("251 namespaces", stairs),
    ]
}
