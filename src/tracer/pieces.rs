//! Boxes whose faces have colours of their own, taken apart into their faces.
//!
//! In: a scene. Out: the scene with six objects in the place of each such box, and which face of
//! which object each of them is. To a ray a face is a flat object, and two that share an edge have
//! the same line for it, so that no ray slips through between them.

use std::{borrow::Cow, sync::Arc};

use crate::scene::{Object, Scene, Shape};

/// What the objects of a scene that was taken apart are; nothing where each is an object.
#[derive(Debug, Default)]
pub(super) struct Pieces(Vec<(usize, Option<u8>)>);

impl Pieces {
    /// Takes a scene apart.
    pub fn of(scene: &Scene) -> (Cow<'_, Scene>, Self) {
        let faces = |object: &Object| match object.shape {
            Shape::Box(cuboid) => cuboid.faces,
            _ => None,
        };
        if scene.objects.iter().all(|object| faces(object).is_none()) {
            return (Cow::Borrowed(scene), Self::default());
        }
        let (mut objects, mut pieces) = (Vec::new(), Vec::new());
        for (owner, object) in scene.objects.iter().enumerate() {
            let (Some(colors), Shape::Box(mut cuboid)) = (faces(object), object.shape) else {
                objects.push(object.clone());
                pieces.push((owner, None));
                continue;
            };
            cuboid.faces = None;
            for face in 0..6 {
                cuboid.color = colors[usize::from(face / 2)];
                let shape = Shape::Box(cuboid);
                let object = object.clone();
                objects.push(Object { shape, ..object });
                pieces.push((owner, Some(face)));
            }
        }
        let scene = scene.clone();
        let objects = Arc::new(objects);
        (Cow::Owned(Scene { objects, ..scene }), Self(pieces))
    }

    /// The index in the file of what a piece is of.
    pub fn owner(&self, piece: usize) -> usize {
        self.0.get(piece).map_or(piece, |(owner, _)| *owner)
    }

    /// The number of the face that a piece is, if it is one.
    pub fn face(&self, piece: usize) -> Option<u8> {
        self.0.get(piece)?.1
    }
}
