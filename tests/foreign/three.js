const camera = new THREE.PerspectiveCamera(45, 640 / 480, 0.1, 1000);
camera.position.set(3, 3.5, 8);
camera.lookAt(0.2, 0.8, 0);
const ball = new THREE.Mesh(
  new THREE.SphereGeometry(1.25, 32, 16),
  new THREE.MeshBasicMaterial({ color: 0x808000 })
);
ball.position.x = -1.6; // to the left
scene.add(ball);
