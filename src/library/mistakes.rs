//! Applies the fixes of a text's mistakes.

use crate::{
    diagnostic::{Applicability, Mistakes},
    scene,
};

impl Mistakes {
    /// Applies the first applicable fix of each mistake, and returns the scene's text. If the new
    /// text has further mistakes, their fixes are applied, too. A fix is applicable if its
    /// [`Applicability`] is at most `most` and is not `Placeholder`. Mistakes without an applicable
    /// fix remain, and so do mistakes in settings (`--set` arguments). [`scene::fix_all`] also
    /// returns which fixes were applied.
    ///
    /// ```
    /// use pinhole::{Applicability, Scene};
    ///
    /// let text = "camera { eye (0, 2, 8)  lookt (0, 1, 0) }  spheree { center (0, 1, 0) }";
    /// let mistakes = Scene::parse(text).unwrap_err();
    /// let text = mistakes.fixed(Applicability::Unsafe);
    /// assert_eq!(text, "camera { eye (0, 2, 8)  lookat (0, 1, 0) }  sphere { center (0, 1, 0) }");
    /// Scene::parse(&text)?;
    /// # Ok::<(), pinhole::Mistakes>(())
    /// ```
    pub fn fixed(&self, most: Applicability) -> String {
        scene::fix_all(self.sources(), most).text
    }
}
