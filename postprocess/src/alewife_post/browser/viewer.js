// Shows the scene of a report: parts to turn, shift and enlarge, coloured by a quantity.
"use strict";

// Numbers of a list that was compressed and written as text.
async function unpacked(text, Kind) {
  const bytes = Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Kind(await new Response(stream).arrayBuffer());
}

async function positions(part) {
  const steps = await unpacked(part.points, Uint16Array);
  const found = new Float32Array(steps.length);
  for (let i = 0; i < steps.length; i++) {
    found[i] = part.low[i % 3] + (steps[i] / 65535) * part.extent[i % 3];
  }
  return found;
}

async function shown(part) {
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.BufferAttribute(await positions(part), 3));
  geometry.setIndex(new THREE.BufferAttribute(await unpacked(part.cells, Uint32Array), 1));
  const look = { color: part.colour, opacity: part.opacity, transparent: part.opacity < 1 };
  look.depthWrite = part.opacity === 1;
  if (part.is_lines) return new THREE.LineSegments(geometry, new THREE.LineBasicMaterial(look));
  look.side = THREE.DoubleSide;
  const isFlat = part.name === "fluid" || part.opacity < 1;
  if (!isFlat) geometry.computeVertexNormals();
  const material = isFlat ? new THREE.MeshBasicMaterial(look) : new THREE.MeshLambertMaterial(look);
  return new THREE.Mesh(geometry, material);
}

// Colours of a part by one quantity; its own colour without one.
async function paint(object, part, quantity) {
  const material = object.material;
  material.vertexColors = Boolean(quantity);
  material.color.set(quantity ? "#ffffff" : part.colour);
  if (quantity) {
    const known = part.quantities[quantity];
    const steps = await unpacked(known.values, Uint8Array);
    const colours = new Float32Array(3 * steps.length);
    const one = new THREE.Color();
    const map = known.colours.map((text) => one.set(text).toArray());
    steps.forEach((step, i) => colours.set(map[step], 3 * i));
    object.geometry.setAttribute("color", new THREE.BufferAttribute(colours, 3));
  }
  material.needsUpdate = true;
}

function legend(place, part, quantity) {
  place.textContent = "";
  if (!quantity) return;
  const known = part.quantities[quantity];
  const bar = document.createElement("span");
  bar.className = "bar";
  bar.style.background = `linear-gradient(to right, ${known.colours.join(",")})`;
  place.append(`${known.low} `, bar, ` ${known.high}  ${known.label}; ${known.note}`);
}

// Directions of the axes, in the lower left corner.
function triad(camera, svg) {
  const middle = 40;
  svg.textContent = "";
  for (const [name, axis] of [["x", [1, 0, 0]], ["y", [0, 1, 0]], ["z", [0, 0, 1]]]) {
    const at = new THREE.Vector3(...axis).transformDirection(camera.matrixWorldInverse);
    const end = [middle + 28 * at.x, middle - 28 * at.y];
    const line = document.createElementNS("http://www.w3.org/2000/svg", "line");
    Object.entries({ x1: middle, y1: middle, x2: end[0], y2: end[1], stroke: "#22262b" }).forEach(
      ([key, value]) => line.setAttribute(key, value),
    );
    const text = document.createElementNS("http://www.w3.org/2000/svg", "text");
    text.setAttribute("x", middle + 37 * at.x - 3);
    text.setAttribute("y", middle - 37 * at.y + 4);
    text.textContent = name;
    svg.append(line, text);
  }
}

function look(camera, controls, given, towards, up) {
  const focus = new THREE.Vector3(...given.focus);
  camera.position.copy(focus).addScaledVector(new THREE.Vector3(...towards), 10 * given.radius);
  camera.up.set(...up);
  camera.zoom = 1;
  controls.target.copy(focus);
  camera.lookAt(focus);
  controls.update();
}

function fit(camera, renderer, given, canvas) {
  const { clientWidth: width, clientHeight: height } = canvas;
  const half = Math.max(given.half[1], (given.half[0] * height) / width);
  Object.assign(camera, { top: half, bottom: -half, left: (-half * width) / height, right: (half * width) / height });
  camera.near = 0;
  camera.far = 40 * given.radius;
  camera.updateProjectionMatrix();
  renderer.setSize(width, height, false);
}

function switches(place, parts, objects, draw) {
  for (const name of new Set(parts.map((part) => part.name))) {
    const label = document.createElement("label");
    const box = Object.assign(document.createElement("input"), { type: "checkbox", checked: true });
    box.addEventListener("change", () => {
      parts.forEach((part, i) => { if (part.name === name) objects[i].visible = box.checked; });
      draw();
    });
    label.append(box, ` ${name}`);
    place.append(label);
  }
}

function choices(place, legends, parts, objects, draw) {
  parts.forEach((part, i) => {
    const names = Object.keys(part.quantities);
    if (names.length === 0) return;
    const select = document.createElement("select");
    select.append(...names.map((name) => new Option(name, name)), new Option("plain", ""));
    select.value = part.chosen;
    const own = document.createElement("div");
    legends.append(own);
    const change = async () => {
      await paint(objects[i], part, select.value);
      legend(own, part, select.value);
      draw();
    };
    select.addEventListener("change", change);
    const label = document.createElement("label");
    label.append(`${part.name}: `, select);
    place.append(label);
  });
}

async function begin(given) {
  const canvas = document.querySelector("#scene canvas");
  const renderer = new THREE.WebGLRenderer({ canvas, antialias: true, preserveDrawingBuffer: true });
  renderer.setPixelRatio(window.devicePixelRatio);
  renderer.setClearColor("#ffffff");
  const scene = new THREE.Scene();
  const camera = new THREE.OrthographicCamera();
  const sun = new THREE.DirectionalLight("#ffffff", 1.6);
  camera.add(sun);
  sun.position.set(0.4, 0.6, 1);
  scene.add(camera, new THREE.AmbientLight("#ffffff", 1.7));
  const objects = await Promise.all(given.parts.map(shown));
  scene.add(...objects);
  const controls = new THREE.TrackballControls(camera, canvas);
  Object.assign(controls, { staticMoving: true, rotateSpeed: 3, zoomSpeed: 1.2, panSpeed: 1 });
  const svg = document.querySelector("#scene svg");
  const draw = () => {
    renderer.render(scene, camera);
    triad(camera, svg);
  };
  const tools = document.querySelector("#tools");
  const legends = document.querySelector("#legends");
  for (const [i, part] of given.parts.entries()) {
    if (part.chosen) await paint(objects[i], part, part.chosen);
  }
  choices(tools, legends, given.parts, objects, draw);
  const coloured = given.parts.filter((one) => Object.keys(one.quantities).length > 0);
  [...legends.children].forEach((own, nth) => legend(own, coloured[nth], coloured[nth].chosen));
  switches(tools, given.parts, objects, draw);
  const views = [["as first seen", given.towards, given.up], ["x", [1, 0, 0], [0, 0, 1]], ["y", [0, -1, 0], [0, 0, 1]], ["z", [0, 0, 1], [0, 1, 0]]];
  for (const [name, towards, up] of given.is_spatial ? views : views.slice(0, 1)) {
    const button = document.createElement("button");
    button.textContent = name === "as first seen" ? name : `along ${name}`;
    button.addEventListener("click", () => { look(camera, controls, given, towards, up); fitted(); });
    tools.append(button);
  }
  const fitted = () => {
    fit(camera, renderer, given, canvas);
    controls.handleResize();
    draw();
  };
  controls.addEventListener("change", draw);
  look(camera, controls, given, given.towards, given.up);
  fitted();
  new ResizeObserver(fitted).observe(canvas);
  const turn = () => { controls.update(); requestAnimationFrame(turn); };
  turn();
  document.body.dataset.scene = "shown";
}

begin(JSON.parse(document.querySelector("#given").textContent)).catch((error) => {
  // Without WebGL, say, the picture remains.
  document.body.dataset.scene = `failed: ${error.message}`;
  document.querySelector("#scene").hidden = true;
  document.querySelector("#still").hidden = false;
});
