//! Tests of the XML parser's limits, with families of texts that take a parser long.

use super::slow_texts::{many_attributes, nested_namespaces, slow_texts};
use super::*;

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
        ("<".repeat((8 << 20) + 1), "8388609 tags"),
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
