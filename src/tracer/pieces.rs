//! Division of boxes with coloured faces into single faces.
//!
//! In: a scene. Out: a new scene, in which each box with coloured faces is replaced by its visible
//! faces; and for each object of the new scene, the index of its original object. The tracer treats
//! each face as a flat object. For an edge of two faces, both compute exactly the same line, so
//! that no ray passes between them.

use std::{array, borrow::Cow, sync::Arc};

use glam::DVec3;

use crate::scene::{Cuboid, Object, Scene, Shape};

/// The faces of a box that become objects.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Faces {
    /// The faces that may be seen in a picture.
    Seen,
    /// All faces, to find every crossing of a ray.
    All,
}

/// Origin of each object of the divided scene: the index of the original object in the file and,
/// for a face of a box, the number of the face. The list is empty if no object was divided.
#[derive(Debug, Default)]
pub(super) struct Pieces(Vec<(usize, Option<u8>)>);

impl Pieces {
    /// Divides every box with coloured faces into the faces that `which` selects. Returns the new
    /// scene and, for each of its objects, the original object. Returns `scene` itself if no box
    /// has coloured faces.
    pub fn of(scene: &Scene, which: Faces) -> (Cow<'_, Scene>, Self) {
        let box_with_faces = |object: &Object| {
            let cuboid = object.shape.cuboid()?;
            Some((*cuboid, cuboid.faces?))
        };
        if scene
            .objects
            .iter()
            .all(|object| box_with_faces(object).is_none())
        {
            return (Cow::Borrowed(scene), Self::default());
        }
        // The near plane may cut off front faces, so that the faces behind them are seen. If there
        // is a near plane, all faces are therefore kept.
        let only_fronts = which == Faces::Seen && scene.camera.near == 0.0;
        let (mut objects, mut pieces) = (Vec::new(), Vec::new());
        for (owner, object) in scene.objects.iter().enumerate() {
            let Some((mut cuboid, colors)) = box_with_faces(object) else {
                objects.push(object.clone());
                pieces.push((owner, None));
                continue;
            };
            cuboid.faces = None;
            let fronts = fronts(&cuboid, scene.camera.eye);
            // If the eye is inside the box, no face is a front face, and rays first hit the back
            // faces. All faces are then kept.
            let only_fronts = only_fronts && fronts.contains(&true);
            for (face, is_front) in (0..).zip(fronts) {
                if only_fronts && !is_front {
                    continue;
                }
                cuboid.color = colors[usize::from(face / 2)];
                objects.push(Object {
                    name: None,
                    indices: Box::default(),
                    shape: Shape::Box(cuboid),
                    span: object.span,
                });
                pieces.push((owner, Some(face)));
            }
        }
        let scene = scene.clone();
        let objects = Arc::new(objects);
        (Cow::Owned(Scene { objects, ..scene }), Self(pieces))
    }

    /// Returns the index in the file of the original object of `piece`, an object of the divided
    /// scene. The original object of a face is its box.
    pub fn owner(&self, piece: usize) -> usize {
        self.0.get(piece).map_or(piece, |(owner, _)| *owner)
    }

    /// Returns the number of the face if `piece`, an object of the divided scene, is a face of a
    /// box. Returns `None` for any other object.
    pub fn face(&self, piece: usize) -> Option<u8> {
        self.0.get(piece)?.1
    }
}

/// Returns for each face whether the eye is on its outer side. The face's number is twice that of
/// its axis, plus one for the greater coordinate.
fn fronts(cuboid: &Cuboid, eye: DVec3) -> [bool; 6] {
    array::from_fn(|face| match (face / 2, face % 2) {
        (axis, 0) => eye[axis] < cuboid.min[axis],
        (axis, _) => eye[axis] > cuboid.max[axis],
    })
}
