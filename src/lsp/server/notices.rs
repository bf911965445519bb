//! What a client tells without asking: texts that are opened, changed and closed.

use gen_lsp_types as lsp;
use lsp_server::Notification;

use super::{
    super::{
        convert,
        documents::{Document, Encoding},
    },
    Phase, Server,
    outbox::{Refusal, parsed},
};

impl Server<'_> {
    /// What the client tells: texts that are opened, changed and closed.
    pub(super) fn notice(&mut self, notification: Notification) {
        let Phase::Talking(client) = &self.phase else {
            return;
        };
        let encoding = client.encoding;
        let method = notification.method.clone();
        let noticed = match method.as_str() {
            "textDocument/didOpen" => {
                parsed(notification.params).map(|params| self.open(params, encoding))
            }
            "textDocument/didChange" => {
                parsed(notification.params).map(|params| self.change(params))
            }
            "textDocument/didClose" => parsed(notification.params).map(|params| self.close(params)),
            // Others are for servers that know more.
            _ => Ok(()),
        };
        if let Err(Refusal(_, message)) = noticed {
            (self.log)(&format!("{method}: {message}"));
        }
    }

    fn open(&mut self, params: lsp::DidOpenTextDocumentParams, encoding: Encoding) {
        let lsp::TextDocumentItem {
            uri, version, text, ..
        } = params.text_document;
        let name = uri.0.rsplit('/').next().unwrap_or_default().to_owned();
        self.changed.insert(uri.0.clone());
        let document = Document::new(&name, version, text, encoding);
        self.documents.insert(uri, document);
    }

    fn change(&mut self, params: lsp::DidChangeTextDocumentParams) {
        let lsp::VersionedTextDocumentIdentifier {
            version,
            text_document_identifier,
        } = params.text_document;
        let uri = text_document_identifier.uri;
        match self.documents.get_mut(&uri) {
            // An old state that comes late would be put on top of a newer one.
            Some(document) if version < document.version => {
                (self.log)(&format!("version {version} of {} is stale", uri.0));
            }
            Some(document) => {
                let changes = params.content_changes.into_iter().map(convert::change);
                document.change(version, changes.collect());
                self.changed.insert(uri.0);
            }
            None => (self.log)(&format!("{} is not open", uri.0)),
        }
    }

    fn close(&mut self, params: lsp::DidCloseTextDocumentParams) {
        let uri = params.text_document.uri;
        self.documents.remove(&uri);
        self.changed.insert(uri.0);
    }
}
