//! The table of all quantities: shape, name, unit, when it exists, meaning; in the order of the columns.

use super::row::Shape::{Quaternion, Scalar, Vector};
use super::row::{Condition, Quantity, Shape};

/// A type with one value per row, and the rows; each row reads
/// `Variant: shape, name, unit, [when it exists], meaning`. Numbers that follow each other with the
/// same unit, conditions and meaning are one row of the user's page.
macro_rules! quantities {
    ($(#[$about:meta])* $group:ident {
        $($row:ident: $shape:expr, $name:literal, $unit:literal, [$($when:ident),*], $meaning:literal;)*
    }) => {
        $(#[$about])*
        #[derive(Debug, Clone, Copy, PartialEq, Eq)]
        pub enum $group {
            $(#[doc = $meaning] $row,)*
        }

        impl $group {
            /// All of them, in the order of the columns.
            pub const TABLE: &[Quantity<Self>] = &[$(Quantity {
                id: Self::$row,
                name: $name,
                shape: $shape,
                unit: $unit,
                when: &[$(Condition::$when),*],
                meaning: $meaning,
            },)*];
        }
    };
}

/// What is the same for the plane and for space but for these words.
const fn rotation(in_space: &'static str) -> Shape {
    Shape::Rotation { in_space }
}

quantities! {
    /// Quantities of a body, named `NAME.x` and so on.
    BodyQuantity {
        Position: Vector, "", "m", [], "Centre of mass, in the laboratory";
        Angle: Scalar, "angle", "rad", [], "Angle, continuous over many turns; in space that of the body's x axis in the x-y plane, within half a turn";
        Orientation: Quaternion, "orientation", "1", [Spatial], "Unit quaternion of the rotation from the body frame to the laboratory";
        Direction: Vector, "direction", "1", [Spatial], "Direction of the body's x axis, in the laboratory";
        Velocity: Vector, "velocity", "m/s", [], "Velocity of the centre of mass";
        AngularVelocity: rotation("In the laboratory"), "angular_velocity", "rad/s", [], "Counter-clockwise";
        BodyAngularVelocity: Vector, "body_angular_velocity", "rad/s", [Spatial], "In the body frame";
        Acceleration: Vector, "acceleration", "m/s2", [],
            "Of the centre of mass; 0 in a steady solution";
        Force: Vector, "force", "N (N/m)", [],
            "Load of the fluid on the body, from the residual: the accurate one";
        Torque: rotation("About the centre of mass, in the laboratory"), "torque", "N m (N)", [],
            "About the centre of mass, the same way";
        SurfaceForce: Vector, "surface_force", "N (N/m)", [],
            "`force` by integrating the stress: a check of lower order";
        SurfaceTorque: rotation("`torque` by integrating the stress: a check of lower order"),
            "surface_torque", "N m (N)", [],
            "`torque` by integrating the stress: a check of lower order";
        Power: Scalar, "power", "W (W/m)", [], "Work of the surface on the fluid";
        DragCoefficient: Scalar, "drag_coefficient", "1", [Scales], "Coefficient of `force.x`";
        LiftCoefficient: Scalar, "lift_coefficient", "1", [Scales], "Coefficient of `force.y`";
        SideCoefficient: Scalar, "side_coefficient", "1", [Scales, Spatial], "Coefficient of `force.z`";
        MomentCoefficient: Scalar, "moment_coefficient", "1", [Scales],
            "Coefficient of `torque`, in space of `torque.z`";
        ContactForce: Vector, "contact_force", "N (N/m)", [Contact],
            "Sum of the contact forces on the body; not in `force`";
        ContactTorque: rotation("Their torque about the centre of mass, in the laboratory"),
            "contact_torque", "N m (N)", [Contact], "Their torque about the centre of mass";
        MagneticTorque: rotation("Torque m x B of the magnetic field, in the laboratory; not in `torque`"),
            "magnetic_torque", "N m (N)", [Moment],
            "Torque m x B of the magnetic field, counter-clockwise; not in `torque`";
        MagneticForce: Vector, "magnetic_force", "N (N/m)", [Moment, FieldGradient],
            "Force grad(m . B) of the magnetic field; not in `force`";
        MagneticLag: Scalar, "magnetic_lag", "rad", [Moment],
            "Angle from the magnetic moment to the field, counter-clockwise, within half a turn, in space from 0 \
             to pi; NaN while there is no field";
        MagneticPower: Scalar, "magnetic_power", "W (W/m)", [Moment],
            "Work of the magnetic field on the body";
        ElasticEnergy: Scalar, "elastic_energy", "J (J/m)", [Rod],
            "Elastic energy of the rod, none of it of muscles";
        KineticEnergy: Scalar, "kinetic_energy", "J (J/m)", [Rod],
            "Kinetic energy of the rod; 0 in `stokes`";
        ActivationPower: Scalar, "activation_power", "W (W/m)", [Activation],
            "Work of muscles or motors within the rod: of active moments, and of a rest curvature that changes";
        EndPower: Scalar, "end_power", "W (W/m)", [EndLoad],
            "Work of the loads that are given at the ends of the rod";
        InternalDissipation: Scalar, "internal_dissipation", "W (W/m)", [Rod],
            "What the damping of the rod takes";
        BaseForce: Vector, "base_force", "N (N/m)", [Attached],
            "Force on the rod at its head by what it is attached to; the opposite acts on that";
        BaseTorque: rotation("The same about the head, in the laboratory"), "base_torque", "N m (N)",
            [Attached], "Torque on the rod about its head by what it is attached to; 0 where it is hinged";
        BasePower: Scalar, "base_power", "W (W/m)", [Attached],
            "Work on the rod of what it is attached to: with that of muscles and loads it is `power`, \
             `internal_dissipation` and the growth of elastic and kinetic energy";
        Tip: Vector, "tip", "m", [Rod], "End of the midline at the tail, in the laboratory";
        Curvature: Scalar, "curvature", "1/m", [Rod],
            "Curvature of the midline where it is largest in size at the middles of its elements, positive where the body turns \
             counter-clockwise from head to tail; in space its size";
    }
}

quantities! {
    /// Quantities of a joint, named after its child: `CHILD.joint.angle` and so on.
    JointQuantity {
        Angle: Scalar, "joint.angle", "rad", [Pivot], "Angle of the child less that of the parent";
        Length: Scalar, "joint.length", "m", [Arm], "Length of the arm, from one joint to the other";
        Rate: Scalar, "joint.rate", "rad/s or m/s", [], "Rate of the angle or length";
        Torque: Scalar, "joint.torque", "N m (N)", [Pivot],
            "Torque of the joint on the child, the opposite on the parent: what a motor there \
             would need; at a hinge that of spring, damper and motor together";
        Force: Scalar, "joint.force", "N (N/m)", [Arm],
            "Force of the arm on the child along it, the opposite on the parent; of a `slider` that of spring, \
             damper and motor together";
        Power: Scalar, "joint.power", "W (W/m)", [],
            "Work of the joint on both bodies: torque or force times rate";
    }
}

quantities! {
    /// Quantities of a swimmer, named `NAME.thrust` and so on.
    SwimmerQuantity {
        Position: Vector, "", "m", [SeveralBodies], "Centre of mass (of volume where there is no mass)";
        Angle: Scalar, "angle", "rad", [SeveralBodies], "Angle of the root body";
        Velocity: Vector, "velocity", "m/s", [SeveralBodies],
            "The rigid motion with the linear momentum of all bodies";
        AngularVelocity:
            rotation("The rigid motion with the angular momentum of all bodies, in the laboratory"),
            "angular_velocity", "rad/s", [SeveralBodies],
            "The rigid motion with the angular momentum of all bodies";
        Force: Vector, "force", "N (N/m)", [SeveralBodies], "Load of the fluid on all bodies";
        Torque: rotation("Its torque about the common centre of mass"), "torque", "N m (N)",
            [SeveralBodies], "Its torque about the common centre of mass";
        Power: Scalar, "power", "W (W/m)", [SeveralBodies], "Work of all surfaces on the fluid";
        ShapePower: Scalar, "shape_power", "W (W/m)", [],
            "Work of the motion of the shape (and slip) on the fluid: `power` without that of the \
             mean rigid motion";
        ExpendedPower: Scalar, "expended_power", "W (W/m)", [],
            "Expended power, without recovery: the same without those parts of the surface where \
             the fluid does work on the body; by integrating the stress, so on coarse meshes it \
             may come out below `shape_power`";
        Thrust: Scalar, "thrust", "N (N/m)", [],
            "Force on the surface along the velocity of the centre of mass, positive; by \
             integrating the stress";
        Drag: Scalar, "drag", "N (N/m)", [],
            "Force on the surface against the velocity of the centre of mass, positive; by \
             integrating the stress";
        MinimumGap: Scalar, "minimum_gap", "m", [SeparateBodies, MovingMesh],
            "Minimum gap between two of its bodies that are not on one pivot; where it falls to that \
             of a few cells, the swimmer touches itself";
        CycleDisplacement: Vector, "cycle", "m", [Cycles],
            "Displacement of the centre of mass over the last cycle; NaN before the first one \
             ends";
        CycleAngle: Scalar, "cycle.angle", "rad", [Cycles],
            "Rotation of the root body over the last cycle; in space the angle of the rotation from \
             its beginning to its end";
        CycleSpeed: Scalar, "cycle.speed", "m/s", [Cycles], "Length of that displacement over the period";
        CyclePower: Scalar, "cycle.power", "W (W/m)", [Cycles], "Mean of `power` over the last cycle";
        CycleCostOfTransport: Scalar, "cycle.cost_of_transport", "J/m (N/m)", [Cycles],
            "Integral of `power` where it is positive, over the length of the displacement";
        CycleEfficiency: Scalar, "cycle.efficiency", "1", [Cycles],
            "P / (P + mean of `shape_power`), P the mean of thrust times speed";
        CycleDrift: Scalar, "cycle.drift", "1", [Cycles],
            "Change of the displacement since the cycle before, over its length";
        CycleLighthillEfficiency: Scalar, "cycle.lighthill_efficiency", "1", [Cycles, Resistance],
            "`resistance` `cycle.speed`^2 / `cycle.power`";
        LighthillEfficiency: Scalar, "lighthill_efficiency", "1", [Resistance, NoCycles],
            "`resistance` speed^2 / `power`";
    }
}

quantities! {
    /// Quantities of a probe, named `NAME.pressure` and so on.
    ProbeQuantity {
        Velocity: Vector, "velocity", "m/s", [], "Velocity at the point, in the laboratory";
        Pressure: Scalar, "pressure", "Pa", [], "Without its hydrostatic part";
    }
}

quantities! {
    /// Quantities of tracers, named `NAME.count` and so on.
    TracerQuantity {
        Position: Vector, "", "m", [], "Mean position of the particles in the fluid, continuous across periodic sides; NaN without any";
        Count: Scalar, "count", "1", [], "Particles in the fluid";
        Left: Scalar, "left", "1", [], "Particles that have left through sides that fluid crosses";
        Dispersion: Vector, "dispersion", "m2", [],
            "Variance of the displacements of the particles in the fluid since their release; NaN without any";
        Inside: Scalar, "inside", "1", [Region], "Particles in the region";
        Residence: Scalar, "residence", "s", [Region],
            "Mean of the time that particles have spent in the region so far, of all that were released";
    }
}

quantities! {
    /// Quantities of a scalar, named `scalar.NAME.total` and so on, in its unit times what is written.
    ScalarQuantity {
        Total: Scalar, "total", "m3 (m2)", [], "Its integral over the fluid";
        Mean: Scalar, "mean", "1", [], "The same over the volume of the fluid";
        Minimum: Scalar, "minimum", "1", [], "Its least value at a node";
        Maximum: Scalar, "maximum", "1", [], "Its largest value at a node";
        Source: Scalar, "source", "m3/s (m2/s)", [], "What is made in the fluid";
        Defect: Scalar, "defect", "m3 (m2)", [Unsteady],
            "`total` less what there was at the start, and less what has come since by `source` and through all bodies \
             and sides: the error of its balance";
    }
}

quantities! {
    /// Quantities of a scalar on a body or a side, named `scalar.NAME.BODY.flux` and so on.
    ScalarSurfaceQuantity {
        Flux: Scalar, "flux", "m3/s (m2/s)", [],
            "What enters the fluid through the surface, by diffusion from the residual and with fluid that crosses it; 0 at the start of a run";
        Sherwood: Scalar, "sherwood", "1", [Difference],
            "Sherwood number: `flux` times the length of `scales`, over diffusivity, `difference` and area of the surface";
    }
}

quantities! {
    /// Quantities of a scalar at a probe, named `scalar.NAME.PROBE.value`.
    ScalarProbeQuantity {
        Value: Scalar, "value", "1", [], "Its value at the point";
    }
}

quantities! {
    /// Quantities of a side of the domain, named `SIDE.force.x` and so on.
    SideQuantity {
        Force: Vector, "force", "N (N/m)", [],
            "Load of the fluid on the side, from the residual as that of bodies: those of all sides and \
             bodies add up to the change of momentum to rounding";
        Torque: rotation("Its torque about the origin"), "torque", "N m (N)", [],
            "Its torque about the origin, counter-clockwise; 0 in axisymmetric cases";
        Flux: Scalar, "flux", "m3/s (m2/s)", [],
            "Volume that enters through the side in a unit of time, negative where it leaves; of a side that goes \
             with a frame, relative to it";
        MeanPressure: Scalar, "mean_pressure", "Pa", [],
            "Mean of the pressure over the side, without its hydrostatic part";
        MeanTraction: Vector, "mean_traction", "Pa", [], "`force` over the area of the side";
    }
}

quantities! {
    /// Quantities of the whole flow, named `flow.dissipation` and so on.
    FlowQuantity {
        Dissipation: Scalar, "dissipation", "W (W/m)", [], "Integral of 2 mu D : D";
        KineticEnergy: Scalar, "kinetic_energy", "J (J/m)", [],
            "Integral of rho u^2 / 2; 0 in `stokes`";
        MassDefect: Scalar, "mass_defect", "m3/s (m2/s)", [],
            "Integral of div u: the net flux of interpolated boundary values";
        EnergyDefect: Scalar, "energy_defect", "1", [IdleSides],
            "Work of bodies, waving sheets and `flow` less dissipation and growth of the kinetic energy, over the work, \
             since the start (`stokes` and steady flows: of the current rates): the error of the \
             energy balance; NaN while there is too little work to tell";
        MomentumDefect: Scalar, "momentum_defect", "1", [ClosedSides],
            "Impulse of the forces less the change of momentum, summed over the fluid and each free \
             body without joint or spring, and without a head that the laboratory holds, over the \
             momentum exchanged by sides and bodies since the twentieth row: the error of the balance of momentum; NaN while that is too little to tell";
        ContactEnergy: Scalar, "contact_energy", "J (J/m)", [Contact],
            "Energy stored in contact: what bodies get back of their kinetic energy";
        ContactEnergyMade: Scalar, "contact_energy_made", "J (J/m)", [Contact],
            "Energy that errors of the steps have made in contact since the start, negative where they have lost it; \
             0 in `stokes`";
        PressureGradient: Vector, "pressure_gradient", "Pa/m", [MeanFlow],
            "Mean pressure gradient, given or what brings a mean velocity about";
        MeanVelocity: Vector, "mean_velocity", "m/s", [MeanFlow],
            "Mean velocity of fluid and bodies: the flux over the cross section of the cell";
        Cfl: Scalar, "cfl", "1", [Convection, Unsteady],
            "CFL number: largest velocity relative to the mesh times the step over the shortest edge \
             of a cell";
        CellReynolds: Scalar, "cell_reynolds", "1", [Convection],
            "Cell Reynolds number: largest density times velocity relative to the mesh times longest \
             edge of a cell, over the viscosity";
        MinimumGap: Scalar, "minimum_gap", "m", [MovingMesh],
            "Minimum gap between two bodies or a body and a wall";
        Cells: Scalar, "cells", "1", [MovingMesh], "Cells of the mesh";
        Remeshes: Scalar, "remeshes", "1", [MovingMesh], "Number of remeshings since the start";
    }
}
