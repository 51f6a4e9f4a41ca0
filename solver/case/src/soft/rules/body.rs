//! What the body of a soft case may be.

use super::mistakes::Mistakes;
use crate::soft::solid::{
    FibreSpec, GridSpec, HoldSpec, MaterialSpec, OutlineSpec, Region, SoftSolid, SolidOrder,
};
use crate::soft::stretch::{Stretch, Trapezoid};
use crate::{Geometry, ShapeSpec};

/// Most cells of a grid.
const MOST_CELLS: usize = 1_000_000;

pub fn check(mistakes: &mut Mistakes<'_>) {
    let solids = mistakes.case().solid.clone();
    let [solid] = solids.as_slice() else {
        let message = format!("there are {} solids", solids.len());
        return mistakes.add("solid", message, "write one [[solid]]: a soft case has one body");
    };
    shape(mistakes, solid);
    material(mistakes, "solid.0.material", solid.order, &solid.material);
    for (n, part) in solid.part.iter().enumerate() {
        region(mistakes, &format!("solid.0.part.{n}.region"), &part.region);
        let key = format!("solid.0.part.{n}.material");
        material(mistakes, &key, solid.order, &part.material);
    }
    for (n, rigid) in solid.rigid.iter().enumerate() {
        region(mistakes, &format!("solid.0.rigid.{n}.region"), &rigid.region);
        mistakes.positive(&format!("solid.0.rigid.{n}.density"), rigid.density);
    }
    for (n, one) in solid.fibre.iter().enumerate() {
        fibre(mistakes, &format!("solid.0.fibre.{n}"), one);
    }
    for (n, one) in solid.hold.iter().enumerate() {
        hold(mistakes, &format!("solid.0.hold.{n}"), one);
    }
}

fn shape(mistakes: &mut Mistakes<'_>, solid: &SoftSolid) {
    let SoftSolid { shape, outline, grid, mesh, size, .. } = solid;
    let given = [shape.is_some(), outline.is_some(), grid.is_some(), mesh.is_some()];
    let n = given.iter().filter(|is_given| **is_given).count();
    if n != 1 {
        let message =
            format!("\"{}\" has {n} of `shape`, `outline`, `grid` and `mesh`", solid.name);
        return mistakes.add("solid.0", message, "write one of them: it says where the body is");
    }
    shape.iter().for_each(|shape| check_shape(mistakes, shape));
    match size {
        Some(size) => mistakes.positive("solid.0.size", *size),
        None if shape.is_some() || outline.is_some() => {
            let message = "the size of the cells is missing".to_owned();
            mistakes.add("solid.0.size", message, "add `size = ...` (m) to [[solid]]");
        }
        None => {}
    }
    outline.iter().for_each(|outline| check_outline(mistakes, outline));
    grid.iter().for_each(|grid| check_grid(mistakes, grid));
    mesh.iter().for_each(|mesh| mistakes.positive("solid.0.mesh.scale", mesh.scale));
}

fn check_shape(mistakes: &mut Mistakes<'_>, shape: &ShapeSpec) {
    let planar = ["disc", "ellipse", "spline", "fish", "flagellate", "tube"];
    let (name, geometry) = (shape.name(), mistakes.case().geometry);
    let is_known = match geometry {
        Geometry::Planar => planar.contains(&name),
        Geometry::Axisymmetric => false,
        Geometry::Spatial => name == "surface",
    };
    if !is_known {
        let message = format!("`solid.0.shape` is a {name} in a case that is {}", geometry.name());
        let help = "accepted: disc, ellipse, spline, fish, flagellate, tube of planar cases, surface of spatial \
                    ones; else write `outline`, `grid` or `mesh`";
        return mistakes.add("solid.0.shape", message, help);
    }
    let ShapeSpec::Surface(surface) = shape else { return };
    let key = "solid.0.shape.surface";
    if surface.data.is_none() {
        let help = "write file = \"body.stl\", the path of an STL, OBJ or PLY file";
        mistakes.add(key, "the surface has no triangles".to_owned(), help);
    }
    mistakes.positive(&format!("{key}.scale"), surface.scale);
    if !(surface.smooth > 0.0 && surface.smooth <= 180.0) {
        let message = format!("`{key}.smooth` is {}", surface.smooth);
        mistakes.add(&format!("{key}.smooth"), message, "write degrees above 0, 180 at most");
    }
}

fn check_outline(mistakes: &mut Mistakes<'_>, outline: &OutlineSpec) {
    let key = "solid.0.outline";
    let n = outline.points.len();
    if n < 3 {
        let message = format!("`{key}.points` has {n} corners");
        mistakes.add(&format!("{key}.points"), message, "write three or more");
    }
    match (outline.z, mistakes.case().geometry) {
        (None, Geometry::Spatial) => {
            let message = format!("`{key}` has no thickness");
            mistakes.add(key, message, "add `z = [FROM, TO]` (m): in space an outline is a plate");
        }
        (Some([from, to]), Geometry::Spatial) if from >= to => {
            let message = format!("`{key}.z` goes from {from} to {to}");
            mistakes.add(&format!("{key}.z"), message, "write two numbers, the smaller one first");
        }
        (Some(_), Geometry::Planar | Geometry::Axisymmetric) => {
            let message = format!("`{key}.z` is given in a case of two dimensions");
            mistakes.add(
                &format!("{key}.z"),
                message,
                "take it out, or write geometry = \"spatial\"",
            );
        }
        _ => {}
    }
    if outline.layers == 0 {
        let message = format!("`{key}.layers` is 0");
        mistakes.add(&format!("{key}.layers"), message, "write 1 or more");
    }
}

fn check_grid(mistakes: &mut Mistakes<'_>, grid: &GridSpec) {
    let key = |part: &str| format!("solid.0.grid.{part}");
    let lengths = [("from", grid.from.len()), ("to", grid.to.len()), ("cells", grid.cells.len())];
    let fit = lengths.map(|(part, n)| mistakes.per_dimension(&key(part), n));
    if fit != [true; 3] {
        return;
    }
    for axis in 0..grid.cells.len() {
        if grid.from[axis] >= grid.to[axis] {
            let message = format!("the grid goes from {} to {}", grid.from[axis], grid.to[axis]);
            let at = format!("{}.{axis}", key("to"));
            mistakes.add(&at, message, "write a larger number, or a smaller one in `from`");
        }
        if grid.cells[axis] == 0 {
            let at = format!("{}.{axis}", key("cells"));
            mistakes.add(&at, "the grid has 0 cells along an axis".to_owned(), "write 1 or more");
        }
    }
    let n = grid.cells.iter().fold(1_usize, |n, cells| n.saturating_mul(*cells));
    if n > MOST_CELLS {
        let message = format!("the grid has {n} cells");
        mistakes.add(&key("cells"), message, &format!("write {MOST_CELLS} at most in all"));
    }
    if mistakes.case().geometry == Geometry::Axisymmetric && grid.from[1] < 0.0 {
        let message = format!("the grid begins at y = {}, beyond the axis", grid.from[1]);
        mistakes.add(&format!("{}.1", key("from")), message, "write 0 or a number above it");
    }
}

fn material(mistakes: &mut Mistakes<'_>, key: &str, order: SolidOrder, material: &MaterialSpec) {
    mistakes.positive(&format!("{key}.young"), material.young);
    mistakes.positive(&format!("{key}.density"), material.density);
    mistakes.not_negative(&format!("{key}.viscosity"), material.viscosity);
    if !(material.poisson > -1.0 && material.poisson <= 0.5) {
        let message = format!("`{key}.poisson` is {}", material.poisson);
        let help = "write a number above -1, 0.5 at most: 0.5 keeps the volume";
        mistakes.add(&format!("{key}.poisson"), message, help);
    } else if material.is_incompressible() && order == SolidOrder::Linear {
        let message = format!("`{key}.poisson` is {}, and cells are linear", material.poisson);
        let help = "write order = \"quadratic\": linear cells that keep their volumes cannot bend; or a smaller ratio";
        mistakes.add(&format!("{key}.poisson"), message, help);
    }
}

fn region(mistakes: &mut Mistakes<'_>, key: &str, region: &Region) {
    let fits = [("from", region.from.len()), ("to", region.to.len())]
        .map(|(part, n)| mistakes.per_dimension(&format!("{key}.{part}"), n));
    if fits == [true; 2] {
        let wrong = region.from.iter().zip(&region.to).position(|(from, to)| from > to);
        if let Some(axis) = wrong {
            let message =
                format!("the region goes from {} to {}", region.from[axis], region.to[axis]);
            mistakes.add(&format!("{key}.to.{axis}"), message, "write the larger number in `to`");
        }
    }
}

fn fibre(mistakes: &mut Mistakes<'_>, key: &str, fibre: &FibreSpec) {
    region(mistakes, &format!("{key}.region"), &fibre.region);
    mistakes.direction(&format!("{key}.direction"), &fibre.direction);
    mistakes.positive(&format!("{key}.stiffness"), fibre.stiffness);
    let at = format!("{key}.stretch");
    match &fibre.stretch {
        Stretch::Constant(value) => mistakes.positive(&format!("{at}.constant"), *value),
        Stretch::Wave(wave) => {
            mistakes.positive(&format!("{at}.wave.frequency"), wave.frequency);
            mistakes.not_negative(&format!("{at}.wave.ramp"), wave.ramp);
            let least = wave.mean - wave.amplitude.abs();
            if least <= 0.0 {
                let message = format!("the stretch falls to {least}");
                let help = "a stretch is above 0, 1 at rest: write a smaller amplitude";
                mistakes.add(&format!("{at}.wave.amplitude"), message, help);
            }
        }
        Stretch::Trapezoid(pulse) => trapezoid(mistakes, &format!("{at}.trapezoid"), pulse),
        Stretch::Frames(values) => {
            let (n, frames) = (values.len(), mistakes.case().soft.frames);
            if n != frames {
                let message = format!("`{at}.frames` has {n} numbers for {frames} frames");
                let help = "write one a frame, or change soft.frames";
                mistakes.add(&format!("{at}.frames"), message, help);
            }
            if let Some(frame) = values.iter().position(|value| *value <= 0.0) {
                mistakes.positive(&format!("{at}.frames.{frame}"), values[frame]);
            }
        }
        Stretch::Record(record) => {
            mistakes.positive(&format!("{at}.record.length"), record.length);
            if mistakes.case().record.is_none() {
                let message = format!("`{at}.record` needs a record, and there is none");
                mistakes.add(&at, message, "add [record] with its file");
            }
        }
    }
}

fn trapezoid(mistakes: &mut Mistakes<'_>, key: &str, pulse: &Trapezoid) {
    let Trapezoid { amplitude, frequency, phase, rise, on } = *pulse;
    mistakes.positive(&format!("{key}.frequency"), frequency);
    mistakes.not_negative(&format!("{key}.phase"), phase);
    mistakes.positive(&format!("{key}.rise"), rise);
    if !(0.0..1.0).contains(&amplitude) {
        let message = format!("the stretch falls to {}", 1.0 - amplitude);
        let help = "write a contraction of 0 or more, below 1";
        mistakes.add(&format!("{key}.amplitude"), message, help);
    }
    if rise > on || on + rise > 1.0 {
        let message =
            format!("pulses rise until {rise}, and fall from {on} to {} of a period", on + rise);
        let help =
            "let them rise before they fall, and fall within a period: rise <= on <= 1 - rise";
        mistakes.add(&format!("{key}.rise"), message, help);
    }
}

fn hold(mistakes: &mut Mistakes<'_>, key: &str, hold: &HoldSpec) {
    region(mistakes, &format!("{key}.region"), &hold.region);
    let n = mistakes.case().geometry.dimensions();
    let axes = hold.axes.as_deref().unwrap_or_default();
    if axes.iter().any(|axis| axis.index() >= n) {
        let message = format!("`{key}.axes` has an axis that a case of {n} dimensions has not");
        mistakes.add(&format!("{key}.axes"), message, "accepted: x, y, and in space z");
    }
}
