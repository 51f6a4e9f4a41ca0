//! Periodic sides of a given mesh: their nodes become pairs when the mesh has been read.

use alewife_mesh::{Unpaired, coordinates_of};

use crate::model::region::opposite;
use crate::text::source::Origin;
use crate::text::tree::{TomlNode, TreeError};
use crate::text::type_error::suggestion;
use crate::{BoundaryCondition, Case, DomainSpec};

/// A side whose partner is periodic is periodic, too, and need not say so.
pub fn complete(case: &mut Case) {
    let given: Vec<&str> = match &case.domain {
        DomainSpec::Mesh(file) => file.side_names(),
        _ => Vec::new(),
    };
    let pairs: Vec<(String, String)> = case
        .boundary
        .iter()
        .filter_map(|(side, condition)| match condition {
            BoundaryCondition::Periodic(partner) => Some((side.clone(), partner.clone())),
            _ => None,
        })
        .filter(|(side, partner)| {
            let is_opposite = given.is_empty() && opposite(side) == Some(partner);
            is_opposite || given.contains(&partner.as_str())
        })
        .collect();
    for (side, partner) in pairs {
        case.boundary.entry(partner).or_insert(BoundaryCondition::Periodic(side));
    }
}

/// Pairs the nodes of periodic sides of a given mesh.
///
/// # Errors
/// When there is no such side, or two are not the same but for a translation along an axis.
pub fn read_into(case: &mut Case, root: &TomlNode) -> Result<(), TreeError> {
    let Case { boundary, domain, .. } = case;
    let DomainSpec::Mesh(file) = domain else { return Ok(()) };
    let mut pairs: Vec<[&str; 2]> = Vec::new();
    for (side, condition) in boundary.iter() {
        let BoundaryCondition::Periodic(partner) = condition else { continue };
        let refused = |message: String, help: &str| TreeError {
            origin: root.find(&format!("boundary.{side}")).node.origin.clone(),
            message,
            help: help.to_owned(),
        };
        let names = file.side_names();
        if !names.contains(&side.as_str()) {
            // Refused with the other sides that are none
            continue;
        }
        if !names.contains(&partner.as_str()) {
            return Err(refused(
                format!("`{side}` is periodic with `{partner}`, and the mesh has no such side"),
                &suggestion(partner, &names),
            ));
        }
        let refers_back = matches!(
            boundary.get(partner),
            Some(BoundaryCondition::Periodic(back)) if back == side
        );
        if !refers_back || partner == side {
            return Err(refused(
                format!("`{side}` is periodic with `{partner}`, which has another condition"),
                &format!("write {partner} = {{ periodic = \"{side}\" }}, or leave `{partner}` out"),
            ));
        }
        if !pairs.iter().any(|pair| pair.contains(&side.as_str())) {
            pairs.push([side, partner]);
        }
    }
    if pairs.is_empty() {
        return Ok(());
    }
    let pairs: Vec<[String; 2]> =
        pairs.into_iter().map(|pair| pair.map(ToOwned::to_owned)).collect();
    file.pair(&pairs).map_err(|unpaired| {
        let place = pairs.iter().find(|pair| match &unpaired.side {
            Some(side) => pair.contains(side),
            None => true,
        });
        let key = place.map_or_else(|| "boundary".to_owned(), |[one, _]| format!("boundary.{one}"));
        let origin = root.find(&key).node.origin.clone();
        told(origin, &unpaired.reason, unpaired.side.as_deref(), &pairs)
    })
}

/// What is wrong, and what helps.
fn told(origin: Origin, reason: &Unpaired, side: Option<&str>, pairs: &[[String; 2]]) -> TreeError {
    match reason {
        Unpaired::Oblique { apart } => {
            let [one, other] = pairs.first().map_or(["", ""], |[one, other]| [one, other]);
            let message = format!(
                "periodic sides lie apart along x, y or z, and of `{one}` and `{other}` or another pair one is {} from \
                 the other",
                coordinates_of(apart)
            );
            let help = "pair sides that face each other along an axis, and turn the mesh where they do not";
            TreeError { origin, message, help: help.to_owned() }
        }
        Unpaired::Node { at, wanted, tolerance, .. } => {
            let message = format!(
                "the node of `{}` at {} has no partner at {}, to {tolerance:.1e}",
                side.unwrap_or_default(),
                coordinates_of(at),
                coordinates_of(wanted)
            );
            let help = "mesh both sides alike: in Gmsh `Periodic Curve {2} = {1} Translate {1, 0, 0};`, in space \
                        `Periodic Surface`";
            TreeError { origin, message, help: help.to_owned() }
        }
    }
}
