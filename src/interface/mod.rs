//! What a bearing shows to the outside: the table of variables, the model description and the page made of it.

pub mod documentation;
pub mod model_description;
pub mod variables;
