//! Treats the volume as data of another kind than it is taken for: with the first look that is for those.

use crate::app::App;
use crate::data::KindName;
use crate::model::auto::{self, Wishes};
use crate::model::{Settings, TransferFunction};

/// First looks that were made of the open volume, by their transfer functions: of which kind of data they are for.
#[derive(Debug, Default)]
pub(in crate::app) struct Treated {
    looks: Vec<(TransferFunction, Option<KindName>)>,
    last: Option<KindName>,
}

impl Treated {
    /// The kind that was chosen for the look that is shown; nothing if that is the volume's own. After steps back and
    /// forward it is that of the look to which they lead, and a look that was changed stays what it was.
    pub(in crate::app) fn shown(&mut self, settings: &Settings) -> Option<KindName> {
        let found = self.looks.iter().rev().find(|(transfer, _)| *transfer == settings.transfer);
        if let Some((_, kind)) = found {
            self.last = *kind;
        }
        self.last
    }
}

impl App {
    /// Another volume is open, with its own look.
    pub(super) fn treat_as_it_is(&mut self) {
        self.treated = Treated { looks: vec![(self.defaults.transfer.clone(), None)], last: None };
    }

    /// Makes the first look anew, for data of a kind; for the volume's own if none is named.
    pub(super) fn treat_as(&mut self, kind: Option<KindName>) {
        let (Some(dataset), Some(facts)) = (self.viewport.dataset(), &self.volume) else { return };
        let wishes = Wishes { treated_as: kind, up: self.settings.camera.up };
        let mut look = auto::first_settings_with(dataset.volume(), &facts.histogram, wishes);
        // As the user has stood it, whatever the file says.
        auto::stand(&mut look, dataset.volume(), self.settings.camera.up);
        // Near what it is: kept, it is found again.
        look.shadows.balance = self.settings.shadows.balance;
        look.shadows.keep_balanced = self.settings.shadows.keep_balanced;
        look.views.clone_from(&self.settings.views);
        self.treated.looks.push((look.transfer.clone(), kind));
        self.treated.last = kind;
        self.defaults = look.clone();
        self.settings = look;
    }

    /// The automatic transfer function, or table of labels, for the kind of data that is shown.
    pub(super) fn use_automatic_transfer(&mut self) {
        let kind = self.treated.shown(&self.settings);
        if let (Some(dataset), Some(facts)) = (self.viewport.dataset(), &self.volume) {
            self.settings.transfer = auto::transfer_as(dataset.volume(), &facts.histogram, kind);
            self.settings.labels = auto::labels_as(dataset.volume(), kind);
        }
    }
}
