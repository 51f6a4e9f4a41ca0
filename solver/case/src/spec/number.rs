//! Ranges of numbers and lengths of lists, as types from which the schema of a key is derived.
//!
//! A key says `schemars(with = "Positive")`, and has its range in the schema, on the page of keys and, by
//! `rules/declared.rs`, in the checks of a case.

use std::borrow::Cow;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};

macro_rules! schemas {
    ($($(#[$doc:meta])* $name:ident = $schema:tt;)*) => {$(
        $(#[$doc])*
        pub enum $name {}

        impl JsonSchema for $name {
            fn inline_schema() -> bool {
                true
            }

            fn schema_name() -> Cow<'static, str> {
                stringify!($name).into()
            }

            fn json_schema(_: &mut SchemaGenerator) -> Schema {
                json_schema!($schema)
            }
        }
    )*};
}

schemas! {
    /// Above 0.
    Positive = { "type": "number", "format": "double", "exclusiveMinimum": 0 };
    /// 0 or above.
    NonNegative = { "type": "number", "format": "double", "minimum": 0 };
    /// Not 0.
    NonZero = { "type": "number", "format": "double", "not": { "const": 0 } };
    /// Between 0 and 1.
    Fraction = {
        "type": "number", "format": "double", "exclusiveMinimum": 0, "exclusiveMaximum": 1
    };
    /// Above 0 and up to 180.
    Degrees = {
        "type": "number", "format": "double", "exclusiveMinimum": 0, "maximum": 180
    };
    /// From 0 to 1.
    UpToOne = { "type": "number", "format": "double", "minimum": 0, "maximum": 1 };
    /// Between -1 and 1.
    BelowOne = {
        "type": "number", "format": "double", "exclusiveMinimum": -1, "exclusiveMaximum": 1
    };
    /// A vector in space that points somewhere.
    Direction = {
        "type": "array", "items": { "type": "number", "format": "double" },
        "minItems": 3, "maxItems": 3, "not": { "const": [0, 0, 0] }
    };
    /// A number for each dimension of the case.
    PerDimension = {
        "type": "array", "items": { "type": "number", "format": "double" },
        "minItems": 2, "maxItems": 3, "perDimension": true
    };
    /// A number or an expression for each dimension of the case.
    FormulaPerDimension = {
        "type": "array", "items": { "type": ["number", "string"] },
        "minItems": 2, "maxItems": 3, "perDimension": true
    };
    /// A number, 0 or above, for each dimension of the case.
    NonNegativePerDimension = {
        "type": "array", "items": { "type": "number", "format": "double", "minimum": 0 },
        "minItems": 2, "maxItems": 3, "perDimension": true
    };
    /// A whole number, 1 or above, for each dimension of the case.
    CountPerDimension = {
        "type": "array", "items": { "type": "integer", "format": "uint", "minimum": 1 },
        "minItems": 2, "maxItems": 3, "perDimension": true
    };
}
