//! Interface of a package: the table of variables, and the model description and documentation page made of it.

pub mod arrays;
pub mod contradiction;
pub mod documentation;
pub mod model_description;
pub mod references;
pub mod terminals;
pub mod variables;
