;; emacs.el: a scene is opened by Emacs as docs/editors.md says, and eglot asks `krs lsp`.  It says "all is well", or what is not.
;;
;;     emacs --batch -l INIT.el -l emacs.el SCENE.krs     INIT.el: what the page has
(require 'eglot)
(defun until (what test)
  "Waits 20 s for TEST; WHAT it is."
  (let ((ends (+ (float-time) 20)))
    (while (and (not (funcall test)) (< (float-time) ends))
      (accept-process-output nil 0.1))
    (unless (funcall test) (error "%s" what))))
(condition-case why
    (with-current-buffer (find-file-noselect (car command-line-args-left))
      (unless (eq major-mode 'krs-mode) (error "its mode is %s" major-mode))
      (apply #'eglot (eglot--guess-contact))
      (until "no server" #'eglot-current-server)
      (flymake-start)
      (until "no mistake is shown" (lambda () (= (length (flymake-diagnostics)) 1)))
      (goto-char (point-min))
      (search-forward "siz")
      (let* ((told (jsonrpc-request (eglot-current-server) :textDocument/hover (eglot--TextDocumentPositionParams)))
             (contents (plist-get (plist-get told :contents) :value)))
        (unless (string-match-p "= 2" contents) (error "hover says %s" contents)))
      (eglot-shutdown (eglot-current-server))
      (message "all is well"))
  (error (message "not well: %s" (error-message-string why))))
