//! Models of other programs, read into the text of a case.

mod bodies;
mod case;
mod defaults;
mod driven;
mod drives;
mod geoms;
mod joined;
mod mass;
mod mjcf;
mod several_joints;
mod source;
mod turn;
mod urdf;
mod words;

pub use source::Remark;

use roxmltree::Document;

use joined::Found;

/// A case of a model.
#[derive(Debug, Clone, PartialEq)]
pub struct Imported {
    /// The text of the case.
    pub text: String,
    /// What of the file is not in it, or otherwise.
    pub notes: Vec<Remark>,
}

/// The text of a case of the model in a file of this name, MJCF or URDF by its first element.
///
/// # Errors
/// When the text is no XML, of another format, or has what the reduced model has not; with the line.
pub fn import(text: &str, file: &str) -> Result<Imported, Remark> {
    let document = Document::parse(text).map_err(|error| Remark {
        line: error.pos().row,
        element: None,
        what: format!("it is no XML: {error}"),
        help: Some("a file of MJCF or URDF".to_owned()),
    })?;
    let root = document.root_element();
    let found = match root.tag_name().name() {
        "mujoco" => mjcf::read(root),
        "robot" => urdf::read(root),
        _ => source::refuse(
            root,
            "it is no model that is known",
            "<mujoco> of MJCF, or <robot> of URDF",
        ),
    }?;
    let Found { robot, mut notes } = found;
    let robot = several_joints::chained(robot, &mut notes);
    let text = case::text(&robot, file, &mut notes);
    notes.sort_by_key(|note| note.line);
    Ok(Imported { text, notes })
}
