//! `SecantMobility`: a mobility of bodies corrected by secants, as in a multisecant quasi-Newton method.
//!
//! Within a step velocities change linearly with loads. Where each response to a load takes the solution of
//! a large system, contact starts from an estimate B of the mobility and corrects it by all loads S whose
//! responses Y are known, so that M S = Y (@fang2009):
//!
//! M = B + (Y - B S) (S^T B S)^-1 S^T B.
//!
//! Where secants of the configuration before have given a mobility A of nearly the same bodies, A takes the place of B in the
//! first two terms.
//!
//! Bodies fall into clusters that are near each other. Each cluster has secants of its own, from loads that act on
//! all of them at once: what they do to each other over a distance is small, and is no part of M. So the
//! number of solutions does not grow with the number of bodies.

use nalgebra::{DMatrix, DVector};

/// Part of the largest singular value of S^T B S below which a load is a combination of the others: 1e-4 of the loads in
/// the norm of B.
const DEPENDENT: f64 = 1e-8;

/// An approximation of the mobility of some bodies, with the secant pairs it satisfies.
#[derive(Debug, Clone)]
pub struct SecantMobility {
    /// The first estimate, symmetric.
    base: DMatrix<f64>,
    /// Before the first secant pair.
    start: DMatrix<f64>,
    matrix: DMatrix<f64>,
    /// Rows of bodies that are near each other.
    clusters: Vec<Vec<usize>>,
    loads: Vec<DVector<f64>>,
    responses: Vec<DVector<f64>>,
}

impl SecantMobility {
    /// Starts from a symmetric positive semidefinite matrix (velocity per load), n x n, whose rows fall into
    /// clusters; rows of zeros stay so.
    #[must_use]
    pub fn new(base: DMatrix<f64>, clusters: Vec<Vec<usize>>) -> Self {
        let (start, matrix) = (base.clone(), base.clone());
        Self { base, start, matrix, clusters, loads: Vec::new(), responses: Vec::new() }
    }

    /// Starts from a mobility (n x n) of nearly the same system, where rows of zeros are the same.
    #[must_use]
    pub fn starting_from(self, mobility: DMatrix<f64>) -> Self {
        Self { start: mobility.clone(), matrix: mobility, ..self }
    }

    /// The mobility, n x n.
    #[must_use]
    pub fn matrix(&self) -> &DMatrix<f64> {
        &self.matrix
    }

    /// The mobility, n x n.
    #[must_use]
    pub fn into_matrix(self) -> DMatrix<f64> {
        self.matrix
    }

    /// Square root of the power of a load at the velocities that the first estimate gives it.
    #[must_use]
    pub fn size(&self, load: &DVector<f64>) -> f64 {
        load.dot(&(&self.base * load)).max(0.0).sqrt()
    }

    /// Velocities in motions that are free, zero in all others.
    #[must_use]
    pub fn free_part(&self, mut velocities: DVector<f64>) -> DVector<f64> {
        for (row, velocity) in velocities.iter_mut().enumerate() {
            if self.base[(row, row)] == 0.0 {
                *velocity = 0.0;
            }
        }
        velocities
    }

    /// Adds a secant pair: a load, and the velocities that it changed.
    pub fn update(&mut self, load: DVector<f64>, response: DVector<f64>) {
        self.loads.push(load);
        self.responses.push(self.free_part(response));
        for rows in &self.clusters {
            let [base, start] = [&self.base, &self.start]
                .map(|matrix| matrix.select_rows(rows).select_columns(rows));
            let [loads, responses] = [&self.loads, &self.responses].map(|vectors| {
                let columns: Vec<_> =
                    vectors.iter().map(|vector| vector.select_rows(rows)).collect();
                DMatrix::from_columns(&columns)
            });
            let Some(block) = corrected(&base, start, loads, responses) else { continue };
            for (i, &row) in rows.iter().enumerate() {
                for (j, &column) in rows.iter().enumerate() {
                    self.matrix[(row, column)] = block[(i, j)];
                }
            }
        }
    }
}

/// The mobility of a cluster by loads and responses, one column each; none where no load acts on it.
fn corrected(
    base: &DMatrix<f64>,
    start: DMatrix<f64>,
    mut loads: DMatrix<f64>,
    mut responses: DMatrix<f64>,
) -> Option<DMatrix<f64>> {
    // Later loads are smaller by orders of magnitude, and known as well relative to their size
    for (mut load, mut response) in loads.column_iter_mut().zip(responses.column_iter_mut()) {
        let size = load.dot(&(base * &load)).max(0.0).sqrt();
        if size > 0.0 {
            load /= size;
            response /= size;
        } else {
            load.fill(0.0);
            response.fill(0.0);
        }
    }
    let by_base = base * &loads;
    let products = loads.transpose() * &by_base;
    let decomposed = products.svd(true, true);
    let largest = decomposed.singular_values.max();
    if largest == 0.0 {
        return None;
    }
    let inverse = decomposed.pseudo_inverse(DEPENDENT * largest).ok()?;
    let missed = responses - &start * &loads;
    Some(start + missed * inverse * by_base.transpose())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Drag of two bodies in three motions with a film between them, and its inverse.
    fn mobility(film: f64) -> DMatrix<f64> {
        let mut resistance = DMatrix::identity(6, 6);
        let along = DVector::from_column_slice(&[0.8, 0.6, 0.0, -0.8, -0.6, 0.0]);
        resistance += film * &along * along.transpose();
        resistance.try_inverse().unwrap()
    }

    #[test]
    fn responses_of_secant_pairs_are_exact() {
        let exact = mobility(30.0);
        let mut estimate = SecantMobility::new(mobility(3.0), vec![(0..6).collect()]);
        let loads = [[1.0, 0.2, 0.0, -1.0, 0.0, 0.3], [1.0, 0.21, 0.0, -1.0, 0.01, 0.3]];
        let loads = loads.map(|load| DVector::from_column_slice(&load));
        for load in &loads {
            estimate.update(load.clone(), &exact * load);
        }
        for load in &loads {
            let difference = estimate.matrix() * load - &exact * load;
            assert!(difference.amax() < 1e-10, "{difference}");
        }
    }

    /// Responses are known up to the accuracy of solutions: the difference of loads that are nearly the same is
    /// rounding.
    #[test]
    fn loads_that_are_nearly_the_same_count_as_one() {
        let exact = mobility(30.0);
        let mut estimate = SecantMobility::new(mobility(3.0), vec![(0..6).collect()]);
        let mut updated = Vec::new();
        for off in [0.0, 1e-7] {
            let load = DVector::from_column_slice(&[1.0, 0.2 + off, 0.0, -1.0, 0.0, 0.3]);
            let error = DVector::from_element(6, off);
            estimate.update(load.clone(), &exact * &load + error);
            updated.push(estimate.matrix().clone());
        }
        assert!((&updated[1] - &updated[0]).amax() < 1e-6);
    }

    #[test]
    fn all_loads_in_all_motions_give_the_mobility() {
        let exact = mobility(30.0);
        let mut estimate = SecantMobility::new(DMatrix::identity(6, 6), vec![(0..6).collect()]);
        for motion in 0..6 {
            let load = exact.column(motion).into_owned();
            estimate.update(load.clone(), &exact * &load);
        }
        assert!((estimate.matrix() - exact).amax() < 1e-10);
    }

    /// A mobility from before is kept where no new load acts.
    #[test]
    fn a_mobility_from_before_is_a_start() {
        let (before, exact) = (mobility(29.0), mobility(30.0));
        let fresh = || SecantMobility::new(mobility(3.0), vec![(0..6).collect()]);
        let mut estimate = fresh().starting_from(before.clone());
        assert_eq!(estimate.matrix(), &before);
        let load = DVector::from_column_slice(&[1.0, 0.2, 0.0, -1.0, 0.0, 0.3]);
        estimate.update(load.clone(), &exact * &load);
        assert!((estimate.matrix() * &load - &exact * &load).amax() < 1e-10);
        let mut again = fresh();
        again.update(load.clone(), &exact * &load);
        let error = |estimate: &SecantMobility| (estimate.matrix() - &exact).amax();
        assert!(error(&estimate) < 0.1 * error(&again), "{} {}", error(&estimate), error(&again));
    }

    #[test]
    fn clusters_are_updated_at_once_and_apart() {
        let [first, second] = [mobility(10.0), mobility(50.0)];
        let mut both = DMatrix::zeros(12, 12);
        both.view_mut((0, 0), (6, 6)).copy_from(&first);
        both.view_mut((6, 6), (6, 6)).copy_from(&second);
        let clusters = vec![(0..6).collect(), (6..12).collect()];
        let mut estimate = SecantMobility::new(DMatrix::identity(12, 12), clusters);
        let load = DVector::from_fn(12, |row, _| 1.0 + row as f64);
        estimate.update(load.clone(), &both * &load);
        for half in [0, 6] {
            let mut part = DVector::zeros(12);
            part.rows_mut(half, 6).copy_from(&load.rows(half, 6));
            assert!((estimate.matrix() * &part - &both * &part).amax() < 1e-12);
        }
    }

    #[test]
    fn motions_that_are_not_free_stay_so() {
        let mut base = DMatrix::identity(3, 3);
        base[(2, 2)] = 0.0;
        let mut estimate = SecantMobility::new(base, vec![vec![0, 1, 2]]);
        let load = DVector::from_column_slice(&[1.0, 1.0, 0.0]);
        estimate.update(load, DVector::from_column_slice(&[2.0, 3.0, 4.0]));
        assert_eq!(estimate.matrix().row(2).amax(), 0.0);
        assert_eq!(estimate.matrix().column(2).amax(), 0.0);
    }
}
