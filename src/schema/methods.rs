//! The table of sampling techniques.

use std::{fmt, str::FromStr};

use thiserror::Error;

use crate::suggest::{self, is_among};

/// Defines the sampling techniques. A line holds the variant, the name in the language, a line of
/// help, and other words that people use by mistake.
macro_rules! methods {
    ($($method:ident $name:literal $help:literal $tried:literal)*) => {
        /// A sampling technique.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        #[non_exhaustive]
        pub enum Method {
            $(#[doc = $help] $method,)*
        }

        impl Method {
            /// Returns the technique's name in the language.
            pub fn name(self) -> &'static str {
                match self {
                    $(Self::$method => $name,)*
                }
            }
        }

        impl Method {
            /// All techniques, in the order in which the language's reference lists them: those
            /// that take samples ([`Self::SAMPLED`]), and then `exact`.
            pub const ALL: &[Self] = &[$(Self::$method),*];
        }

        /// Every sampling technique, with a line of help.
        pub const METHODS: &[(Method, &str)] = &[$((Method::$method, $help)),*];

        /// Words that people use by mistake for each technique. The words for one technique are
        /// separated by spaces.
        const ALSO_TRIED: &[(Method, &str)] = &[$((Method::$method, $tried)),*];
    };
}

methods! {
    Regular "regular" "an even grid, centred" "grid uniform_grid centered"
    Random "random" "independent and uniform" "monte_carlo independent white_noise"
    Jittered "jittered" "one at random in each cell of a grid" "stratified"
    NRooks "n_rooks" "one in each row and each column" "latin_hypercube lhs rooks"
    MultiJittered "multi_jittered" "jittered and n_rooks at once" "cmj correlated_multi_jittered"
    Hammersley "hammersley" "the Hammersley points, shifted per pixel" ""
    Halton "halton" "the Halton points, shifted per pixel" ""
    Sobol "sobol" "Sobol' points with Owen scrambling, per pixel" "owen low_discrepancy"
    Scatter "scatter" "points uniform over the whole picture" ""
    Exact "exact" "no samples: the mean itself, computed" "analytic analytical"
}

impl Method {
    /// Techniques that take samples, i.e. all except `exact`. They are in the order in which the
    /// language's reference lists them.
    pub const SAMPLED: [Self; 9] = [
        Self::Regular,
        Self::Random,
        Self::Jittered,
        Self::NRooks,
        Self::MultiJittered,
        Self::Hammersley,
        Self::Halton,
        Self::Sobol,
        Self::Scatter,
    ];
}

/// Writes the method's name in the language, such as `multi_jittered`.
impl fmt::Display for Method {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// Parses the method's name in the language, such as `multi_jittered`.
impl FromStr for Method {
    type Err = UnknownMethod;

    fn from_str(word: &str) -> Result<Self, UnknownMethod> {
        method(word).ok_or_else(|| UnknownMethod(word.to_owned()))
    }
}

/// Error for a word that is not the name of a method.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("there is no method `{0}`; the methods are {list}", list = suggest::list(method_names()))]
pub struct UnknownMethod(String);

/// Returns the sampling technique with the name `name` in the language, or `None` if there is none.
pub fn method(name: &str) -> Option<Method> {
    let mut methods = METHODS.iter().map(|&(method, _)| method);
    methods.find(|method| method.name() == name)
}

/// Returns the name of the technique that was probably meant by `written`. Returns `None` if no
/// name is similar.
pub fn nearest_method(written: &str) -> Option<&'static str> {
    let mut tried = ALSO_TRIED.iter();
    let tried = tried.find(|(_, words)| is_among(written, words));
    let tried = tried.map(|(method, _)| method.name());
    tried.or_else(|| suggest::nearest(written, method_names()))
}

/// Returns whether `written` certainly means the technique named `near`. This is so if `written` is
/// a word that people use by mistake for this technique, or if `near` is the only technique with a
/// similar name.
pub fn is_sure_method(written: &str, near: &str) -> bool {
    let mut tried = ALSO_TRIED.iter();
    tried.any(|(method, words)| method.name() == near && is_among(written, words))
        || suggest::is_only_near(written, near, method_names())
}

/// Returns the names of the sampling techniques.
pub fn method_names() -> impl Iterator<Item = &'static str> {
    METHODS.iter().map(|(method, _)| method.name())
}
