// The screenshots: for each, a scene and the actions in the editor before the picture is taken.

const mistaken = `// A ball and a crate. Two words are not quite right.
let ball = (-1.6, 1, 0)

image   { width 1280  height 720  background midnightblue }
sampler { method multi_jittered  per_pixel 16 }

sphere Ball  { center ball  radus 1  color olive }
box    Crate { center (2, 0.75, -0.5)  color #c60 }
checkerboard { square 1  colors (gray, white) }

camera {
  eye    ball + 4 * (1, 0.6, 2)
  lookat (0.2, 0.8, 0)
  roll   30
}
`;

const unfinished = `// A ball on a checkered floor, seen from a corner.
let ball = (-1.6, 1, 0)

camera {
  eye    (3, 3.5, 8)
  lookat ball
  
}

sphere Ball  { center ball  radius 1  color olive }
checkerboard { square 1  colors (gray, white) }
`;

export const shots = [
  {
    name: "fix",
    width: 940,
    height: 550,
    scene: mistaken,
    async prepare({ at, trigger, pause }) {
      await at("ball  rad");
      await trigger("editor.action.marker.next");
      await pause(500);
      await at("roll   3");
      await trigger("editor.action.quickFix");
    },
  },
  {
    name: "complete",
    width: 940,
    height: 340,
    scene: unfinished,
    async prepare({ at, choose, trigger, pause }) {
      await at("lookat ball\n  ");
      await trigger("editor.action.triggerSuggest");
      await pause(1000);
      await choose("fov");
      await trigger("toggleSuggestionDetails");
    },
  },
];
