;;; pinhole-mode.el --- Scenes of the Pinhole renderer  -*- lexical-binding: t; -*-

;; SPDX-License-Identifier: MIT OR Apache-2.0
;; Package-Requires: ((emacs "28.1"))

;;; Commentary:

;; A mode for *.scn, which registers Pinhole's language server with eglot and lsp-mode, if they are
;; installed.  The mode itself colours comments, numbers, colour codes, `let', `for' and the heads
;; of blocks; everything else comes from the server.

;;; Code:

(defvar pinhole-mode-syntax-table
  (let ((table (make-syntax-table)))
    (modify-syntax-entry ?/ ". 124b" table)
    (modify-syntax-entry ?* ". 23" table)
    (modify-syntax-entry ?\n "> b" table)
    (modify-syntax-entry ?_ "w" table)
    ;; Quotation marks have no meaning in scenes, so they do not start a string.
    (modify-syntax-entry ?\" "." table)
    table))

(defconst pinhole-font-lock-keywords
  '(("\\_<\\(?:let\\|for\\)\\_>" . 'font-lock-keyword-face)
    ;; The head of a block: its kind and its name.
    ("\\_<\\([a-z]+\\)\\_>\\(?:[ \t]+\\([A-Za-z_][A-Za-z0-9_]*\\)\\)?\\(?:[ \t]+for\\_>[^{}]*\\)?[ \t]*{"
     (1 'font-lock-type-face) (2 'font-lock-variable-name-face nil t))
    ("#[0-9A-Fa-f]+\\_>" . 'font-lock-constant-face)
    ("\\_<[0-9][0-9_]*\\(?:\\.[0-9_]*\\)?\\(?:[eE][-+]?[0-9]+\\)?\\(?:deg\\|rad\\)?\\_>"
     . 'font-lock-constant-face)))

;;;###autoload
(define-derived-mode pinhole-mode prog-mode "Pinhole"
  "Major mode for the scenes of Pinhole."
  (setq-local comment-start "// "
              comment-start-skip "\\(?://+\\|/\\*+\\)\\s-*"
              comment-end ""
              indent-tabs-mode nil
              tab-width 2
              font-lock-defaults '(pinhole-font-lock-keywords)))

;;;###autoload
(add-to-list 'auto-mode-alist '("\\.scn\\'" . pinhole-mode))

(defvar eglot-server-programs)
(with-eval-after-load 'eglot
  (add-to-list 'eglot-server-programs '(pinhole-mode "pinhole" "lsp")))

(declare-function lsp-register-client "lsp-mode")
(declare-function make-lsp-client "lsp-mode")
(declare-function lsp-stdio-connection "lsp-mode")
(declare-function lsp-activate-on "lsp-mode")
(defvar lsp-language-id-configuration)
(with-eval-after-load 'lsp-mode
  (add-to-list 'lsp-language-id-configuration '(pinhole-mode . "pinhole"))
  (lsp-register-client
   (make-lsp-client :new-connection (lsp-stdio-connection '("pinhole" "lsp"))
                    :activation-fn (lsp-activate-on "pinhole")
                    :server-id 'pinhole)))

(provide 'pinhole-mode)
;;; pinhole-mode.el ends here
