//! The paths of particles through a step, by the classical Runge-Kutta method.

use alewife_mesh::{Neighbours, Point, whole};
use rayon::prelude::*;

use super::cloud::{Cloud, Fate, Particle};
use super::flow_step::{FlowStep, Found, Instant};
use super::source::Source;

/// Cells that the fastest particle may cross in a part of a step.
const CELLS_PER_PART: f64 = 1.0;

/// Most parts of a step on a mesh that stays, and on one that moves, which is searched anew in each.
const MOST_PARTS: [f64; 2] = [64.0, 8.0];

/// Particles a thread takes at a time.
const PARTICLES_PER_TASK: usize = 64;

/// Carries all clouds through a step, and releases what is to be released in it or at its end.
///
/// Particles are independent of each other, and none depends on the number of threads. Seeds that are not in the fluid
/// are left out; their number is reported. A particle that comes out of the mesh has left where fluid does; elsewhere, at
/// a wall or a body, it is put on the nearest place of the fluid.
pub fn carry<const D: usize>(
    clouds: &mut [Cloud<D>],
    sources: &[Source<D>],
    step: &FlowStep<'_, D>,
) {
    let neighbours = Neighbours::new(step.mesh);
    for (cloud, source) in clouds.iter_mut().zip(sources) {
        let course = Course { step, source, neighbours: &neighbours };
        if step.length() > 0.0 {
            course.follow(&mut cloud.particles, 0.0);
        }
        while let Some(time) = source.next_release(cloud.releases, step.times[1], step.length()) {
            let part = match step.length() > 0.0 {
                true => ((time - step.times[0]) / step.length()).clamp(0.0, 1.0),
                false => 1.0,
            };
            let mut released = course.release(time, part);
            if part < 1.0 {
                course.follow(&mut released, part);
            }
            cloud.particles.extend(released);
            cloud.releases += 1;
        }
    }
}

/// One step of particles from one source.
struct Course<'a, const D: usize> {
    step: &'a FlowStep<'a, D>,
    source: &'a Source<D>,
    neighbours: &'a Neighbours<D>,
}

impl<const D: usize> Course<'_, D> {
    /// Particles at the seeds that are in the fluid at a part of the step.
    fn release(&self, released: f64, part: f64) -> Vec<Particle<D>> {
        let instant = Instant::new(self.step, part, self.neighbours);
        let seeds = &self.source.seeds;
        let begun: Vec<Particle<D>> = seeds
            .par_iter()
            .enumerate()
            .with_min_len(PARTICLES_PER_TASK)
            .filter_map(|(seed, start)| {
                let found = instant.find(part, start, usize::MAX)?;
                // Places on curved sides are outside by the error of the quadratic mesh
                let is_in = found.distance <= 1e-3 * instant.cell_size(found.cell);
                is_in.then(|| Particle {
                    seed,
                    released,
                    start: *start,
                    position: *start,
                    velocity: found.velocity,
                    shift: found.shift,
                    cell: found.cell.index(),
                    residence: 0.0,
                    is_inside: self.is_inside(&(start + found.shift)),
                    fate: Fate::InFluid,
                })
            })
            .collect();
        let (name, left_out) = (&self.source.name, seeds.len() - begun.len());
        if begun.is_empty() {
            tracing::warn!(time = released, "no seed of the tracers `{name}` is in the fluid");
        } else if left_out > 0 {
            tracing::info!(
                time = released,
                left_out,
                "seeds of `{name}` that are not in the fluid"
            );
        }
        begun
    }

    /// Whether a place in the mesh (m), or one of its images, is in the region.
    fn is_inside(&self, place: &Point<D>) -> bool {
        let Some(region) = &self.source.region else { return false };
        self.step.images.iter().any(|image| region.holds(&(place - image)))
    }

    /// Carries particles from a part of the step to its end.
    fn follow(&self, particles: &mut [Particle<D>], from: f64) {
        if !particles.iter().any(Particle::is_in_fluid) {
            return;
        }
        let mut first = Instant::new(self.step, from, self.neighbours);
        let n = self.n_parts(particles, &first, from);
        let mut start = from;
        for nth in 1..=whole(n) {
            let end = if nth == whole(n) { 1.0 } else { from + (1.0 - from) * nth as f64 / n };
            let parts = [start, 0.5 * (start + end), end];
            if self.step.moves() {
                let [middle, last] =
                    [1, 2].map(|nth| Instant::new(self.step, parts[nth], self.neighbours));
                self.part([&first, &middle, &last], parts, particles);
                first = last;
            } else {
                self.part([&first; 3], parts, particles);
            }
            start = end;
        }
    }

    /// Parts of the rest of a step, of which the fastest particle crosses a cell in each.
    fn n_parts(&self, particles: &[Particle<D>], first: &Instant<'_, D>, from: f64) -> f64 {
        let rest = (1.0 - from) * self.step.length();
        let crossed = particles
            .par_iter()
            .with_min_len(PARTICLES_PER_TASK)
            .filter(|particle| particle.is_in_fluid())
            .filter_map(|particle| {
                let place = particle.position + particle.shift;
                let speed = [from, 1.0].map(|part| {
                    let found = first.find(part, &place, particle.cell)?;
                    Some(found.velocity.norm() / first.cell_size(found.cell))
                });
                Some(rest * speed[0]?.max(speed[1]?))
            })
            .reduce(|| 0.0, f64::max);
        let most = MOST_PARTS[usize::from(self.step.moves())];
        (crossed / CELLS_PER_PART).ceil().clamp(1.0, most)
    }

    /// Parts of a step, by the mesh at their beginning, in their middle and at their end.
    fn part(&self, instants: [&Instant<'_, D>; 3], parts: [f64; 3], particles: &mut [Particle<D>]) {
        let time = (parts[2] - parts[0]) * self.step.length();
        let carried = particles.par_iter_mut().with_min_len(PARTICLES_PER_TASK);
        carried.filter(|particle| particle.is_in_fluid()).for_each(|particle| {
            let stage =
                |nth: usize, place: &Point<D>, near| instants[nth].find(parts[nth], place, near);
            if let Some(way) = runge_kutta(particle, time, stage) {
                self.arrive(particle, instants[2], way, time);
            }
        });
    }

    /// Puts a particle at the end of its way (m) through a part of a step in time (s).
    fn arrive(&self, particle: &mut Particle<D>, end: &Instant<'_, D>, way: Point<D>, time: f64) {
        let place = particle.position + particle.shift + way;
        // The end of a part is another part of the step, but the velocity is asked for at the end of it only
        let Some(found) = end.find(1.0, &place, particle.cell) else { return };
        if found.distance > 0.0 {
            let back = end.place(&found) - found.shift;
            if end.has_left(&place, &found) {
                particle.fate = Fate::Left;
            }
            particle.position = back - particle.shift;
        } else {
            particle.position += way;
        }
        particle.shift += found.shift;
        particle.velocity = found.velocity;
        particle.cell = found.cell.index();
        let is_inside = self.is_inside(&(particle.position + particle.shift));
        let share = [particle.is_inside, is_inside].map(|is_in| if is_in { 0.5 } else { 0.0 });
        particle.residence += time * (share[0] + share[1]);
        particle.is_inside = is_inside;
    }
}

/// The way of a particle (m) in a time (s), by velocities at the beginning, in the middle and at the end of it.
fn runge_kutta<const D: usize>(
    particle: &Particle<D>,
    time: f64,
    stage: impl Fn(usize, &Point<D>, usize) -> Option<Found<D>>,
) -> Option<Point<D>> {
    let start = particle.position + particle.shift;
    let first = stage(0, &start, particle.cell)?;
    let near = first.cell.index();
    let second = stage(1, &(start + first.velocity * (0.5 * time)), near)?;
    let third = stage(1, &(start + second.velocity * (0.5 * time)), near)?;
    let last = stage(2, &(start + third.velocity * time), third.cell.index())?;
    let middle = (second.velocity + third.velocity) * 2.0;
    Some((first.velocity + middle + last.velocity) * (time / 6.0))
}
