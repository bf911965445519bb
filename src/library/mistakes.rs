//! Applies the fixes of a text's mistakes.

use crate::{
    diagnostic::{Applicability, Mistakes},
    scene,
};

impl Mistakes {
    /// Returns the scene's text after the first applicable fix of each mistake was applied, and
    /// then those of the mistakes that this revealed. Fixes up to `most` are applied, except
    /// placeholders. Mistakes without such a fix remain, and so do mistakes of settings.
    /// [`scene::fix_all`] also returns which fixes were applied.
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
