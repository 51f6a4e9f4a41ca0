//! `Series`: named quantities over the steps of a run, the content of `series.csv`.

/// Named quantities over time. Every row has one value a name.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Series {
    /// Names of the columns after `time`, such as `cylinder.force.x`.
    pub names: Vec<String>,
    /// Time of each row (s).
    pub times: Vec<f64>,
    /// The rows.
    pub rows: Vec<Vec<f64>>,
}

impl Series {
    /// The column of that name, if there is one.
    #[must_use]
    pub fn column(&self, name: &str) -> Option<Vec<f64>> {
        let index = self.names.iter().position(|known| known == name)?;
        Some(self.rows.iter().map(|row| row[index]).collect())
    }
}
