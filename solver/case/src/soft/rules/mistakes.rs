//! `Mistakes`: what is wrong in a soft case, as found so far.

use crate::soft::read::SoftFile;
use crate::soft::spec::SoftCase;
use crate::text::diagnostic::Diagnostic;

/// The mistakes found so far.
pub struct Mistakes<'a> {
    pub file: &'a SoftFile,
    pub found: Vec<Diagnostic>,
}

impl Mistakes<'_> {
    pub fn case(&self) -> &SoftCase {
        &self.file.case
    }

    pub fn add(&mut self, key: &str, message: String, help: &str) {
        self.found.push(self.file.error(key, message, help));
    }

    /// A number that has to be above 0.
    pub fn positive(&mut self, key: &str, value: f64) {
        if value <= 0.0 {
            self.add(key, format!("`{key}` is {value}"), "write a number above 0");
        }
    }

    /// A number that cannot be below 0.
    pub fn not_negative(&mut self, key: &str, value: f64) {
        if value < 0.0 {
            self.add(key, format!("`{key}` is {value}"), "write 0 or a number above it");
        }
    }

    /// A list with a number for each dimension; says whether it is one.
    pub fn per_dimension(&mut self, key: &str, n: usize) -> bool {
        let geometry = self.case().geometry;
        let wanted = geometry.dimensions();
        if n != wanted {
            let message = format!("`{key}` has {n} numbers");
            let help = format!("write {wanted}, as the case is {}", geometry.name());
            self.add(key, message, &help);
        }
        n == wanted
    }

    /// A direction.
    pub fn direction(&mut self, key: &str, values: &[f64]) {
        if self.per_dimension(key, values.len()) && values.iter().all(|value| *value == 0.0) {
            let message = format!("`{key}` is 0: it points nowhere");
            self.add(key, message, "write a vector that is not 0; its length does not matter");
        }
    }
}
