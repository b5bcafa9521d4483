//! Instances of parts with names of their own.

/// An instance of an assembly, or an effect that acts on many.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Instance {
    /// Its full name: `front_left`, in an assembly `car.front_left`.
    pub name: String,
    /// Kind.
    pub kind: InstanceKind,
}

/// Kind of an instance.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum InstanceKind {
    /// An instance of the assembly of this name.
    Assembly(String),
    /// An assembly, whose parameters that all its instances share are called after it.
    Definition,
    /// An effect with one part for each joint or body that it acts on.
    Effect,
}
