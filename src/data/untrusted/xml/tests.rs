//! Tests of the XML parser's limits, with families of texts that take a parser long.

use super::*;

/// Makes a root with `count` namespaces, and as many children that each declare one more: cubic in the parser.
pub(crate) fn nested_namespaces(name: &str, count: usize) -> String {
    let declared = (0..count).map(|at| format!(" xmlns:a{at}=\"u{at}\"")).collect::<Vec<String>>().concat();
    format!("<{name}{declared}>{}</{name}>", "<x xmlns:q=\"z\"/>".repeat(count))
}

/// Makes one element with `count` attributes: quadratic in the parser.
pub(crate) fn many_attributes(name: &str, count: usize) -> String {
    let attributes = (0..count).map(|at| format!(" a{at}=\"\"")).collect::<Vec<String>>().concat();
    format!("<{name}{attributes}/>")
}

/// Texts of less than a megabyte for which the parser alone takes from 9 s to hours, each with a fragment of the
/// expected error. The root element is called `root`.
pub(crate) fn slow_texts(root: &str) -> Vec<(&'static str, String)> {
    let namespaces = nested_namespaces(root, 8000);
    let attributes = many_attributes(root, 60_000);
    // Attributes with a prefix, whose namespace has a long URI.
    let prefixed = (0..4000).map(|at| format!(" p:a{at}=\"\"")).collect::<Vec<String>>().concat();
    let prefixed = format!("<{root} xmlns:p=\"{}\"{prefixed}/>", "u".repeat(600_000));
    // Long names that differ in their last character.
    let long = (0..4000)
        .map(|at| format!(" {}{}=\"\"", "n".repeat(200), char::from_u32(0x4e00 + at).unwrap()))
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

#[test]
fn expensive_texts_are_rejected_unparsed() {
    for (words, text) in slow_texts("r") {
        let error = parse(&text).unwrap_err();
        assert!(error.to_string().contains(words), "{words}: {error}");
        assert!(!error.to_string().contains('\n'), "{error}");
    }
    // The expensive part follows what looks like the end of the text, or like a comment.
    for before in ["<?xml version=\"1.0\"?><!-- > -- <!x -->", "<?p <!x ?>", "\u{feff}"] {
        let text = format!("{before}{}", nested_namespaces("r", 2000));
        assert!(matches!(parse(&text), Err(XmlError::Comparisons { namespaces: 2001, .. })), "{before}");
    }
    for inside in ["<![CDATA[ <!x ]>]] ]]>", "<!--<a b='-->", "<b c='>' d=\"'/>\"/>", "a > b ' \" &lt; ="] {
        let text = format!("<r>{inside}{}</r>", many_attributes("e", 20_000));
        assert!(matches!(parse(&text), Err(XmlError::Comparisons { attributes: 20_000, .. })), "{inside}");
    }
    let text = format!("<r  z = '1'\n{}", &many_attributes("e", 20_000)[2..]);
    assert!(matches!(parse(&text), Err(XmlError::Comparisons { attributes: 20_001, .. })));
}

#[test]
fn real_files_are_parsed() {
    // The number of planes of a long recording, below the namespaces that the schema's own files declare.
    let declared = (0..12)
        .map(|at| format!(" xmlns:N{at}=\"http://www.example.org/Schemas/{at}\""))
        .collect::<Vec<String>>()
        .concat();
    let planes = 40_000;
    let plane = "<TiffData FirstC=\"0\" FirstT=\"3\" FirstZ=\"12\" IFD=\"7\" PlaneCount=\"1\"><UUID FileName=\"a.ome.tif\">urn:uuid:1\
                 </UUID></TiffData><Plane DeltaT=\"1.5\" ExposureTime=\"0.1\" PositionX=\"1\" PositionY=\"2\" PositionZ=\"3\" \
                 TheC=\"0\" TheT=\"3\" TheZ=\"12\"/>";
    let notes =
        "<OriginalMetadata xmlns=\"\"><Key>k</Key><Value>v &amp; w</Value></OriginalMetadata>".repeat(10_000);
    let text = format!(
        "<?xml version=\"1.0\"?><OME xmlns=\"o\"{declared}><Pixels>{}</Pixels>{notes}</OME>",
        plane.repeat(planes)
    );
    let document = parse(&text).unwrap();
    let count = |name: &str| document.descendants().filter(|node| node.has_tag_name(name)).count();
    assert_eq!((count("TiffData"), count("Plane"), count("Value")), (planes, planes, 10_000));
    // A single element may have more attributes than any schema defines.
    assert_eq!(parse(&many_attributes("a", 5000)).unwrap().root_element().attributes().count(), 5000);
    assert!(parse(&nested_namespaces("r", 200)).is_ok());
}

#[test]
fn errors_name_the_problem() {
    for (text, words) in [
        ("<a>", "not well-formed XML"),
        ("<a b=c/>", "not well-formed XML"),
        ("", "not well-formed XML"),
        ("<a/><b/>", "not well-formed XML"),
        ("<a b='1' b='2'/>", "'b'"),
        ("<a>&b;</a>", "'b'"),
        ("<!DOCTYPE a [<!ENTITY b '&c;&c;'>]><a>&b;</a>", "document type"),
    ] {
        let error = parse(text).unwrap_err().to_string();
        assert!(error.contains(words), "{text}: {error}");
    }
    // The parser quotes the name in its error.
    let name = format!("<{}>\n</b>", "a".repeat(1 << 20));
    assert!(parse(&name).unwrap_err().to_string().len() < 2 * MAX_ERROR_BYTES);
    for (text, words) in [
        ("<".repeat((8 << 20) + 1), "8388609 marks"),
        (format!("<a>{}</a>", "=".repeat((8 << 20) + 1)), "equals signs"),
        (format!("<a>{}</a>", " ".repeat(MAX_XML_BYTES)), "67108871 bytes"),
        (format!("<a>{}</a>", "b<?c?>".repeat(3 << 20)), "elements and texts"),
    ] {
        let error = parse(&text).unwrap_err().to_string();
        assert!(error.contains(words), "{error}");
    }
    // A long comment and a long text are cheap.
    assert!(parse(&format!("<a><!--{}-->{}</a>", " <".repeat(1 << 20), "b".repeat(8 << 20))).is_ok());
}
