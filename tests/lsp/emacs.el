;; -*- lexical-binding: t; -*-
;; Script for Emacs: opens the scene, starts the server by eglot or lsp-mode, as CLIENT says, and
;; records the diagnostics, the completions, and the text after a fix, a renaming and formatting.

(require 'package)
(package-initialize)
(require 'seq)

(defvar found nil)
(defvar client (intern (getenv "CLIENT")))

(defun note (what value) (push (cons what value) found))

(defun wait-for (condition)
  (let ((end (+ (float-time) 60)))
    (while (not (funcall condition))
      (when (> (float-time) end) (error "Not within a minute: %S" condition))
      (accept-process-output nil 0.05))))

(defun messages ()
  "What is told of the text: by flymake, or by lsp-mode itself, whose reports flymake may not show
in batch."
  (or (mapcar (lambda (it) (flymake-diagnostic-text it)) (flymake-diagnostics))
      (unless (eq client 'eglot)
        (mapcar (lambda (it) (lsp-get it :message)) (lsp--get-buffer-diagnostics)))))

(defun complete-here ()
  "What the client's completion at point offers for what is typed."
  (let ((capf (run-hook-with-args-until-success 'completion-at-point-functions)))
    (pcase-let ((`(,start ,end ,table . ,_) capf))
      (all-completions (buffer-substring-no-properties start end) table))))

(defun type (text)
  (goto-char (point-max))
  (dolist (letter (append text nil)) (insert letter)))

(condition-case failure
    (progn
      (load (getenv "MODE") nil t)
      (setq-default lsp-auto-guess-root t lsp-enable-snippet nil lsp-enable-file-watchers nil
                    lsp-diagnostics-provider :flymake lsp-headerline-breadcrumb-enable nil
                    lsp-session-file (expand-file-name "session" default-directory)
                    eglot-sync-connect 10 flymake-no-changes-timeout 0.2)
      (require client)
      (find-file "scene.scn")
      (note 'mode major-mode)
      (if (eq client 'eglot) (call-interactively #'eglot)
        (lsp-workspace-folders-add default-directory)
        (lsp)
        (wait-for (lambda () (bound-and-true-p lsp--buffer-workspaces)))
        (wait-for (lambda () (eq (lsp--workspace-status (car lsp--buffer-workspaces)) 'initialized))))
      (flymake-mode 1)
      (wait-for (lambda () (flymake-start) (accept-process-output nil 0.1) (messages)))
      (note 'told (messages))
      (type "\nsph")
      (note 'completed (complete-here))
      (delete-region (line-beginning-position) (point))
      (goto-char (point-min))
      (search-forward "radu")
      (if (eq client 'eglot) (eglot-code-actions (point) (point) "quickfix" t)
        (lsp-execute-code-action-by-kind "quickfix"))
      (wait-for (lambda () (string-search "radius" (buffer-string))))
      ;; The timer that sends changes to the server does not run in batch mode.
      (if (eq client 'eglot) (eglot--signal-textDocument/didChange))
      (goto-char (point-min))
      (search-forward "let ")
      (if (eq client 'eglot) (eglot-rename "height") (lsp-rename "height"))
      (if (eq client 'eglot) (eglot--signal-textDocument/didChange))
      (if (eq client 'eglot) (eglot-format-buffer) (lsp-format-buffer))
      (note 'text (buffer-string)))
  (error (note 'failure (format "%S" failure))))

(with-temp-file "answers.json" (insert (json-encode found)))
(kill-emacs 0)
