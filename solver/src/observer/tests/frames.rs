//! Field files and their list name each other, and what they are of.

use super::*;

#[test]
fn the_list_of_frames_names_every_frame_and_is_closed() {
    let place = tempfile::tempdir().unwrap();
    Run::new().complete(place.path());
    let text = std::fs::read_to_string(place.path().join("fields.pvd")).unwrap();
    for (time, file) in [("0.0", "000000"), ("1.0", "000010"), ("4.0", "000040")] {
        let line = format!("timestep=\"{time}\" part=\"0\" file=\"fields/{file}.vtu\"/>");
        assert!(text.contains(&line), "{line} is not in\n{text}");
    }
    assert!(text.ends_with("</Collection>\n</VTKFile>\n"));
    let frame = std::fs::read(place.path().join("fields/000040.vtu")).unwrap();
    let header = String::from_utf8_lossy(&frame);
    for name in ["TimeValue", "velocity", "pressure", "vorticity"] {
        assert!(header.contains(&format!("Name=\"{name}\"")), "{name}");
    }
    assert!(header.ends_with("</VTKFile>\n"));
    // What it is of stands in the second line, which is a comment
    let hash = crc32fast::hash(&std::fs::read(place.path().join("case.toml")).unwrap());
    for text in [text.as_str(), &*header] {
        let line = text.lines().nth(1).unwrap();
        assert!(line.contains(&format!("case crc32:{hash:08x} -->")), "{line}");
    }
}
