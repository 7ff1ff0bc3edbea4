// three.mjs: a solid of krs as a mesh in a scene of three.js, and a slider that changes it.
import * as THREE from 'three';
import * as krs from 'krs';

krs.locate('krs/'); // where workers and the compiler are

const text = `param blend = 0.2 in [0, 0.5];
show union([box([1, 1, 1]), sphere(0.5).move([0.5, 0.5, 0.5])], blend: blend);`;

const renderer = new THREE.WebGLRenderer({ antialias: true }), world = new THREE.Scene();
const camera = new THREE.PerspectiveCamera(40, innerWidth / innerHeight, 0.1, 100);
renderer.setSize(innerWidth, innerHeight);
document.body.append(renderer.domElement);
camera.position.set(2, 2, 3);
camera.lookAt(0.2, 0.2, 0.2);
world.add(new THREE.HemisphereLight('white', 'gray', 2), new THREE.DirectionalLight('white', 2));

const scene = await krs.compile(text);
const solid = new THREE.Mesh(new THREE.BufferGeometry(), new THREE.MeshStandardMaterial({ color: '#c8553d' }));
world.add(solid);

async function rebuild() {
    const { vertices, triangles } = await scene.mesh({ error: 0.01, draft: true });
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute('position', new THREE.BufferAttribute(new Float32Array(vertices), 3));
    geometry.setIndex(new THREE.BufferAttribute(triangles, 1));
    solid.geometry.dispose();
    solid.geometry = geometry.toNonIndexed();
    solid.geometry.computeVertexNormals();
    renderer.render(world, camera);
}
const slider = Object.assign(document.createElement('input'), { type: 'range', min: 0, max: 0.5, step: 'any', value: 0.2 });
slider.oninput = () => scene.set('blend', Number(slider.value)).then(rebuild);
document.body.append(slider);
await rebuild();
