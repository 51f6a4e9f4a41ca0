//! The table of all quantities: name, unit, when it exists, meaning; in the order of the columns.

use super::row::{Quantity, When};

/// A type with one value per row, and the rows; each row reads
/// `Variant: name, unit, when it exists, meaning`. Rows that follow each other with the same unit
/// and meaning are one row of the user's page.
macro_rules! quantities {
    ($(#[$about:meta])* $group:ident {
        $($row:ident: $name:literal, $unit:literal, $when:ident, $meaning:literal;)*
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
                unit: $unit,
                when: When::$when,
                meaning: $meaning,
            },)*];
        }
    };
}

quantities! {
    /// Quantities of a body, named `NAME.x` and so on.
    BodyQuantity {
        X: "x", "m", Always, "Centre of mass, in the laboratory";
        Y: "y", "m", Always, "Centre of mass, in the laboratory";
        Z: "z", "m", Spatial, "Centre of mass, in the laboratory";
        Angle: "angle", "rad", Always, "Angle, continuous over many turns; in space that of the body's x axis in the x-y plane, within half a turn";
        OrientationW: "orientation.w", "1", Spatial, "Unit quaternion of the rotation from the body frame to the laboratory";
        OrientationX: "orientation.x", "1", Spatial, "Unit quaternion of the rotation from the body frame to the laboratory";
        OrientationY: "orientation.y", "1", Spatial, "Unit quaternion of the rotation from the body frame to the laboratory";
        OrientationZ: "orientation.z", "1", Spatial, "Unit quaternion of the rotation from the body frame to the laboratory";
        DirectionX: "direction.x", "1", Spatial, "Direction of the body's x axis, in the laboratory";
        DirectionY: "direction.y", "1", Spatial, "Direction of the body's x axis, in the laboratory";
        DirectionZ: "direction.z", "1", Spatial, "Direction of the body's x axis, in the laboratory";
        VelocityX: "velocity.x", "m/s", Always, "Velocity of the centre of mass";
        VelocityY: "velocity.y", "m/s", Always, "Velocity of the centre of mass";
        VelocityZ: "velocity.z", "m/s", Spatial, "Velocity of the centre of mass";
        AngularVelocity: "angular_velocity", "rad/s", Plane, "Counter-clockwise";
        AngularVelocityX: "angular_velocity.x", "rad/s", Spatial, "In the laboratory";
        AngularVelocityY: "angular_velocity.y", "rad/s", Spatial, "In the laboratory";
        AngularVelocityZ: "angular_velocity.z", "rad/s", Spatial, "In the laboratory";
        BodyAngularVelocityX: "body_angular_velocity.x", "rad/s", Spatial, "In the body frame";
        BodyAngularVelocityY: "body_angular_velocity.y", "rad/s", Spatial, "In the body frame";
        BodyAngularVelocityZ: "body_angular_velocity.z", "rad/s", Spatial, "In the body frame";
        AccelerationX: "acceleration.x", "m/s2", Always,
            "Of the centre of mass; 0 in a steady solution";
        AccelerationY: "acceleration.y", "m/s2", Always,
            "Of the centre of mass; 0 in a steady solution";
        AccelerationZ: "acceleration.z", "m/s2", Spatial,
            "Of the centre of mass; 0 in a steady solution";
        ForceX: "force.x", "N (N/m)", Always,
            "Load of the fluid on the body, from the residual: the accurate one";
        ForceY: "force.y", "N (N/m)", Always,
            "Load of the fluid on the body, from the residual: the accurate one";
        ForceZ: "force.z", "N (N/m)", Spatial,
            "Load of the fluid on the body, from the residual: the accurate one";
        Torque: "torque", "N m (N)", Plane, "About the centre of mass, the same way";
        TorqueX: "torque.x", "N m", Spatial, "About the centre of mass, in the laboratory";
        TorqueY: "torque.y", "N m", Spatial, "About the centre of mass, in the laboratory";
        TorqueZ: "torque.z", "N m", Spatial, "About the centre of mass, in the laboratory";
        SurfaceForceX: "surface_force.x", "N (N/m)", Always,
            "`force` by integrating the stress: a check of lower order";
        SurfaceForceY: "surface_force.y", "N (N/m)", Always,
            "`force` by integrating the stress: a check of lower order";
        SurfaceForceZ: "surface_force.z", "N (N/m)", Spatial,
            "`force` by integrating the stress: a check of lower order";
        SurfaceTorque: "surface_torque", "N m (N)", Plane,
            "`torque` by integrating the stress: a check of lower order";
        SurfaceTorqueX: "surface_torque.x", "N m", Spatial,
            "`torque` by integrating the stress: a check of lower order";
        SurfaceTorqueY: "surface_torque.y", "N m", Spatial,
            "`torque` by integrating the stress: a check of lower order";
        SurfaceTorqueZ: "surface_torque.z", "N m", Spatial,
            "`torque` by integrating the stress: a check of lower order";
        Power: "power", "W (W/m)", Always, "Work of the surface on the fluid";
        DragCoefficient: "drag_coefficient", "1", Scales, "Coefficient of `force.x`";
        LiftCoefficient: "lift_coefficient", "1", Scales, "Coefficient of `force.y`";
        SideCoefficient: "side_coefficient", "1", SpatialScales, "Coefficient of `force.z`";
        MomentCoefficient: "moment_coefficient", "1", Scales,
            "Coefficient of `torque`, in space of `torque.z`";
        ContactForceX: "contact_force.x", "N (N/m)", Contact,
            "Sum of the contact forces on the body; not in `force`";
        ContactForceY: "contact_force.y", "N (N/m)", Contact,
            "Sum of the contact forces on the body; not in `force`";
        ContactForceZ: "contact_force.z", "N (N/m)", SpatialContact,
            "Sum of the contact forces on the body; not in `force`";
        ContactTorque: "contact_torque", "N m (N)", PlaneContact,
            "Their torque about the centre of mass";
        ContactTorqueX: "contact_torque.x", "N m", SpatialContact,
            "Their torque about the centre of mass, in the laboratory";
        ContactTorqueY: "contact_torque.y", "N m", SpatialContact,
            "Their torque about the centre of mass, in the laboratory";
        ContactTorqueZ: "contact_torque.z", "N m", SpatialContact,
            "Their torque about the centre of mass, in the laboratory";
    }
}

quantities! {
    /// Quantities of a joint, named after its child: `CHILD.joint.angle` and so on.
    JointQuantity {
        Angle: "joint.angle", "rad", Pivot, "Angle of the child less that of the parent";
        Length: "joint.length", "m", Arm, "Length of the arm, from one joint to the other";
        Rate: "joint.rate", "rad/s or m/s", Always, "Rate of the angle or length";
        Torque: "joint.torque", "N m (N)", Pivot,
            "Torque of the joint on the child, the opposite on the parent: what a motor there \
             would need; at a hinge that of spring, damper and motor together";
        Force: "joint.force", "N (N/m)", Arm,
            "Force of the arm on the child along it, the opposite on the parent; of a `slider` that of spring, \
             damper and motor together";
        Power: "joint.power", "W (W/m)", Always,
            "Work of the joint on both bodies: torque or force times rate";
    }
}

quantities! {
    /// Quantities of a swimmer, named `NAME.thrust` and so on.
    SwimmerQuantity {
        X: "x", "m", SeveralBodies, "Centre of mass (of volume where there is no mass)";
        Y: "y", "m", SeveralBodies, "Centre of mass (of volume where there is no mass)";
        Z: "z", "m", SpatialSeveralBodies, "Centre of mass (of volume where there is no mass)";
        Angle: "angle", "rad", SeveralBodies, "Angle of the root body";
        VelocityX: "velocity.x", "m/s", SeveralBodies,
            "The rigid motion with the linear momentum of all bodies";
        VelocityY: "velocity.y", "m/s", SeveralBodies,
            "The rigid motion with the linear momentum of all bodies";
        VelocityZ: "velocity.z", "m/s", SpatialSeveralBodies,
            "The rigid motion with the linear momentum of all bodies";
        AngularVelocity: "angular_velocity", "rad/s", PlaneSeveralBodies,
            "The rigid motion with the angular momentum of all bodies";
        AngularVelocityX: "angular_velocity.x", "rad/s", SpatialSeveralBodies,
            "The rigid motion with the angular momentum of all bodies, in the laboratory";
        AngularVelocityY: "angular_velocity.y", "rad/s", SpatialSeveralBodies,
            "The rigid motion with the angular momentum of all bodies, in the laboratory";
        AngularVelocityZ: "angular_velocity.z", "rad/s", SpatialSeveralBodies,
            "The rigid motion with the angular momentum of all bodies, in the laboratory";
        ForceX: "force.x", "N (N/m)", SeveralBodies, "Load of the fluid on all bodies";
        ForceY: "force.y", "N (N/m)", SeveralBodies, "Load of the fluid on all bodies";
        ForceZ: "force.z", "N", SpatialSeveralBodies, "Load of the fluid on all bodies";
        Torque: "torque", "N m (N)", PlaneSeveralBodies,
            "Its torque about the common centre of mass";
        TorqueX: "torque.x", "N m", SpatialSeveralBodies,
            "Its torque about the common centre of mass";
        TorqueY: "torque.y", "N m", SpatialSeveralBodies,
            "Its torque about the common centre of mass";
        TorqueZ: "torque.z", "N m", SpatialSeveralBodies,
            "Its torque about the common centre of mass";
        Power: "power", "W (W/m)", SeveralBodies, "Work of all surfaces on the fluid";
        ShapePower: "shape_power", "W (W/m)", Always,
            "Work of the motion of the shape (and slip) on the fluid: `power` without that of the \
             mean rigid motion";
        ExpendedPower: "expended_power", "W (W/m)", Always,
            "Expended power, without recovery: the same without those parts of the surface where \
             the fluid does work on the body; by integrating the stress, so on coarse meshes it \
             may come out below `shape_power`";
        Thrust: "thrust", "N (N/m)", Always,
            "Force on the surface along the velocity of the centre of mass, positive; by \
             integrating the stress";
        Drag: "drag", "N (N/m)", Always,
            "Force on the surface against the velocity of the centre of mass, positive; by \
             integrating the stress";
        MinimumGap: "minimum_gap", "m", MovingMembers,
            "Minimum gap between two of its bodies that are not on one pivot; where it falls to that \
             of a few cells, the swimmer touches itself";
        CycleX: "cycle.x", "m", Cycles,
            "Displacement of the centre of mass over the last cycle; NaN before the first one \
             ends";
        CycleY: "cycle.y", "m", Cycles,
            "Displacement of the centre of mass over the last cycle; NaN before the first one \
             ends";
        CycleZ: "cycle.z", "m", SpatialCycles,
            "Displacement of the centre of mass over the last cycle; NaN before the first one \
             ends";
        CycleAngle: "cycle.angle", "rad", Cycles,
            "Rotation of the root body over the last cycle; in space the angle of the rotation from \
             its beginning to its end";
        CycleSpeed: "cycle.speed", "m/s", Cycles, "Length of that displacement over the period";
        CyclePower: "cycle.power", "W (W/m)", Cycles, "Mean of `power` over the last cycle";
        CycleCostOfTransport: "cycle.cost_of_transport", "J/m (N/m)", Cycles,
            "Integral of `power` where it is positive, over the length of the displacement";
        CycleEfficiency: "cycle.efficiency", "1", Cycles,
            "P / (P + mean of `shape_power`), P the mean of thrust times speed";
        CycleDrift: "cycle.drift", "1", Cycles,
            "Change of the displacement since the cycle before, over its length";
        CycleLighthillEfficiency: "cycle.lighthill_efficiency", "1", TowedCycles,
            "`resistance` `cycle.speed`^2 / `cycle.power`";
        LighthillEfficiency: "lighthill_efficiency", "1", TowedWithoutCycles,
            "`resistance` speed^2 / `power`";
    }
}

quantities! {
    /// Quantities of a probe, named `NAME.pressure` and so on.
    ProbeQuantity {
        VelocityX: "velocity.x", "m/s", Always, "Velocity at the point, in the laboratory";
        VelocityY: "velocity.y", "m/s", Always, "Velocity at the point, in the laboratory";
        VelocityZ: "velocity.z", "m/s", Spatial, "Velocity at the point, in the laboratory";
        Pressure: "pressure", "Pa", Always, "Without its hydrostatic part";
    }
}

quantities! {
    /// Quantities of the whole flow, named `flow.dissipation` and so on.
    FlowQuantity {
        Dissipation: "dissipation", "W (W/m)", Always, "Integral of 2 mu D : D";
        KineticEnergy: "kinetic_energy", "J (J/m)", Always,
            "Integral of rho u^2 / 2; 0 in `stokes`";
        MassDefect: "mass_defect", "m3/s (m2/s)", Always,
            "Integral of div u: the net flux of interpolated boundary values";
        EnergyDefect: "energy_defect", "1", IdleSides,
            "Work of bodies, waving sheets and `flow` less dissipation and growth of the kinetic energy, over the work, \
             since the start (`stokes` and steady flows: of the current rates): the error of the \
             energy balance; NaN while there is too little work to tell";
        MomentumDefect: "momentum_defect", "1", ClosedSides,
            "Impulse of the forces less the change of momentum, summed over the fluid and each free \
             body without joint or spring, over the momentum exchanged by sides and bodies since the \
             twentieth row: the error of the balance of momentum; NaN while that is too little to tell";
        PressureGradientX: "pressure_gradient.x", "Pa/m", MeanFlow,
            "Mean pressure gradient along x, given or what brings a mean velocity about";
        PressureGradientY: "pressure_gradient.y", "Pa/m", MeanFlow, "The same along y";
        PressureGradientZ: "pressure_gradient.z", "Pa/m", SpatialMeanFlow, "The same along z";
        MeanVelocityX: "mean_velocity.x", "m/s", MeanFlow,
            "Mean velocity of fluid and bodies along x: the flux over the cross section of the cell";
        MeanVelocityY: "mean_velocity.y", "m/s", MeanFlow, "The same along y";
        MeanVelocityZ: "mean_velocity.z", "m/s", SpatialMeanFlow, "The same along z";
        Cfl: "cfl", "1", UnsteadyConvection,
            "CFL number: largest velocity relative to the mesh times the step over the shortest edge \
             of a cell";
        CellReynolds: "cell_reynolds", "1", Convection,
            "Cell Reynolds number: largest density times velocity relative to the mesh times longest \
             edge of a cell, over the viscosity";
        MinimumGap: "minimum_gap", "m", MovingMesh,
            "Minimum gap between two bodies or a body and a wall";
        Cells: "cells", "1", MovingMesh, "Cells of the mesh";
        Remeshes: "remeshes", "1", MovingMesh, "Number of remeshings since the start";
    }
}
