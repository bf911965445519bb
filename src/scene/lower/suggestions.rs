//! Withdraws suggested names that would lead to another error.
//!
//! In: a function that evaluates a value. Out: the value, and reports of mistakes in it. A name is
//! suggested only if the value with that name has no further error, such as a wrong type, a wrong
//! number of arguments, or a broken condition of its field.

use super::lowering::Lowering;
use crate::{diagnostic::Diagnostic, scene::eval::Suggestion, source::Span};

impl<'s> Lowering<'s> {
    /// Evaluates a value with `evaluate` and returns the result. Then evaluates it again with each
    /// suggested name, and withdraws suggestions that cause more errors.
    pub(super) fn with_tried_suggestions<T>(
        &mut self,
        value: Span,
        evaluate: impl Fn(&mut Self) -> T,
    ) -> T {
        let before = self.problems.len();
        let found = evaluate(self);
        let suggestions = self.names.suggestions.take();
        let errors = |problems: &[Diagnostic]| {
            let errors = problems.iter().filter(|it| it.is_error());
            errors.filter(|it| !it.is_of_suggestion()).count()
        };
        let errors_before = errors(self.problems.get(before..).unwrap_or_default());
        for suggestion in suggestions {
            let is_wrong = !self.names.budget().spend(value.range().len()) || {
                let problems = std::mem::take(&mut self.problems);
                self.names.suggestions.set_tried(Some(&suggestion));
                evaluate(self);
                self.names.suggestions.set_tried(None);
                errors(&std::mem::replace(&mut self.problems, problems)) > errors_before
            };
            if is_wrong {
                self.withdraw(suggestion);
            }
        }
        found
    }

    /// Removes the fixes for a suggestion from its report, and replaces the help.
    fn withdraw(&mut self, suggestion: Suggestion<'s>) {
        self.names.withdraw(suggestion.name);
        let mut of_names = self.names.problems.borrow_mut();
        let mut all = of_names.iter_mut().chain(self.problems.iter_mut());
        let problem = all.find(|problem| {
            let first = problem.labels.first();
            problem.is_of_suggestion() && first.is_some_and(|it| it.span == suggestion.report)
        });
        if let Some(problem) = problem {
            problem.fixes.clear();
            problem.help = Some(suggestion.otherwise);
        }
    }
}
