// 3-D playback: cut-open races, balls with marks, cage, contact ellipses, force arrows coloured by load.

import {
  WebGLRenderer, Scene, PerspectiveCamera, HemisphereLight, DirectionalLight, Group, Mesh, MeshStandardMaterial, MeshBasicMaterial, LatheGeometry, SphereGeometry,
  CircleGeometry, CylinderGeometry, ConeGeometry, BoxGeometry, ShapeGeometry, Shape, CanvasTexture, Vector2, Vector3, Quaternion, Color, DoubleSide, SRGBColorSpace, 
} from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';
import { h, section, choice, select } from './dom.js';
import { clock } from './clock.js';
import { css, isDark, onTheme, viridis, viridisCss } from './theme.js';
import { ringSections, cageSection } from './shape.js';
import { rowAt } from './data.js';
import { digits } from './units.js';

/** Millimetres on the scene: easier for cameras than metres. */
const MM = 1e3;
/** A quarter of the races is cut away. */
const CUT = Math.PI / 2;
const X = new Vector3(1, 0, 0);

export function playback(run) {
  const canvas = h('canvas', { class: 'view', tabindex: 0, role: 'img', 'aria-label': `3-D view of the bearing. Space plays, arrow keys step, 1 to 4 choose the camera.` });
  const words = h('p', { class: 'note', 'aria-live': 'off', id: 'frame-words' });
  const fail = h('p', { class: 'warning', hidden: true }, 'This browser shows no 3-D pictures (WebGL).');
  const state = { races: true, arrows: true, ellipses: true, cage: true, outer: 'cut', camera: 'free', magnify: 1 };
  const box = (key, text) => h('label', { class: 'check' }, h('input', { type: 'checkbox', checked: true, onchange: event => { state[key] = event.target.checked; view?.update(); } }), text);
  let view = null;
  const part = section('playback', 'Playback', h('div', { class: 'row' },
    choice('Camera', [['free', 'oblique'], ['front', 'front (+x)'], ['side', 'side'], ['ball', 'with the cage']], 'free', camera => { state.camera = camera; view?.place(); }),
    box('races', 'races'), run.bearing.cage ? box('cage', 'cage') : null, box('arrows', 'forces'), box('ellipses', 'contact ellipses'),
    select('Displacements', [['1', 'to scale'], ['100', '\u00d7 100'], ['1000', '\u00d7 1000']], '1', text => { state.magnify = Number(text); view?.update(); })),
  h('div', { class: 'stage' }, canvas, legend(run)), fail, words);
  new IntersectionObserver((changes, observer) => {
    if (!changes.some(change => change.isIntersecting)) return;
    observer.disconnect();
    try {
      view = new View(run, canvas, words, state);
      window.roulementView = view;
    } catch (why) {
      fail.hidden = false;
      fail.append(` ${why.message ?? why}`);
    }
  }, { rootMargin: '400px' }).observe(canvas);
  canvas.addEventListener('keydown', event => {
    if (event.key >= '1' && event.key <= '4') part.querySelectorAll('.choice button')[Number(event.key) - 1].click();
  });
  return part;
}

/** Largest load of the run, the top of the scale of colours. */
function largestLoad(run) {
  return Math.max(...['inner', 'outer'].flatMap(race => run.ofBalls(`${race}.load`).map(name => run.range(name)[1])), 1e-9);
}

function legend(run) {
  const most = largestLoad(run);
  const stops = Array.from({ length: 9 }, (_, i) => viridisCss(i / 8)).join(',');
  return h('div', { class: 'scale', 'aria-hidden': 'true' }, h('span', {}, `${digits(most, 3)} N`), h('div', { style: `background:linear-gradient(to top,${stops})` }), h('span', {}, '0 N'));
}

/** Surface of a ball: two tones in eight gores, so that every rotation is seen. */
function ballTexture() {
  const canvas = document.createElement('canvas');
  [canvas.width, canvas.height] = [512, 256];
  const c = canvas.getContext('2d');
  for (let i = 0; i < 8; i++) for (let j = 0; j < 2; j++) {
    c.fillStyle = (i + j) % 2 ? '#c9ced6' : '#eceff3';
    c.fillRect(i * 64, j * 128, 64, 128);
  }
  c.fillStyle = '#c2410c';
  c.fillRect(0, 120, 512, 16);
  c.fillStyle = '#1d4ed8';
  c.fillRect(24, 0, 16, 256);
  const texture = new CanvasTexture(canvas);
  texture.colorSpace = SRGBColorSpace;
  return texture;
}

/** A ring cut open, with faces where it is cut; lathes turn about y, bearings about x. */
function cutRing(polygon, material) {
  const group = new Group();
  const points = [...polygon, polygon[0]].map(([x, r]) => new Vector2(r * MM, -x * MM));
  group.add(new Mesh(new LatheGeometry(points, 96, 0, 2 * Math.PI - CUT), material));
  const shape = new Shape(polygon.map(([x, r]) => new Vector2(r * MM, -x * MM)));
  for (const angle of [0, 2 * Math.PI - CUT]) {
    const face = new Mesh(new ShapeGeometry(shape), material.clone());
    face.material.side = DoubleSide;
    face.material.color.multiplyScalar(0.82);
    // The lathe begins in the plane of y and z.
    face.rotation.y = angle - Math.PI / 2;
    group.add(face);
  }
  const turned = new Group();
  turned.add(group);
  group.rotation.z = Math.PI / 2;
  return turned;
}

class View {
  constructor(run, canvas, words, state) {
    Object.assign(this, { run, canvas, words, state });
    this.renderer = new WebGLRenderer({ canvas, antialias: true, preserveDrawingBuffer: true });
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    this.scene = new Scene();
    this.camera = new PerspectiveCamera(32, 1.6, 1, 1e5);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.enableDamping = false;
    this.controls.addEventListener('change', () => this.render());
    // The page scrolls by the wheel unless the view is in use.
    this.controls.enableZoom = false;
    canvas.addEventListener('focus', () => { this.controls.enableZoom = true; });
    canvas.addEventListener('blur', () => { this.controls.enableZoom = false; });
    this.scene.add(new HemisphereLight(0xffffff, 0x8890a0, 2.2));
    const sun = new DirectionalLight(0xffffff, 1.9);
    sun.position.set(3, 2, 4);
    this.scene.add(sun);
    this.mostLoad = largestLoad(run);
    this.build();
    this.orient();
    this.place();
    new ResizeObserver(() => this.fit()).observe(canvas);
    this.fit();
    onTheme(() => { this.colours(); this.render(); });
    this.colours();
    // Out of sight nothing is drawn.
    this.inSight = true;
    new IntersectionObserver(([change]) => { this.inSight = change.isIntersecting; if (this.inSight) this.update(); }).observe(canvas);
    let waiting = false;
    clock.follow(() => {
      if (waiting || !this.inSight) return;
      waiting = true;
      requestAnimationFrame(() => { waiting = false; this.update(); });
    });
  }

  /** Bodies. */
  build() {
    const { bearing } = this.run;
    const sections = ringSections(bearing);
    const steel = color => new MeshStandardMaterial({ color, metalness: 0.35, roughness: 0.42, side: DoubleSide });
    this.rings = {};
    for (const race of ['inner', 'outer']) {
      const group = new Group();
      const ring = cutRing(sections[race], steel(race === 'inner' ? 0x7ea6c9 : 0xc79a6b));
      // Marks turn with the race, its cut stays where it is.
      const marks = new Group();
      const rs = sections[race].map(p => p[1]), xs = sections[race].map(p => p[0]);
      const [low, high] = [Math.min(...rs), Math.max(...rs)];
      const rim = race === 'inner' ? low : high;
      const depth = 0.3 * (high - low);
      for (let i = 0; i < 4; i++) {
        const size = [(Math.max(...xs) - Math.min(...xs)) * 1.012 * MM, depth * MM, (i === 0 ? 0.09 : 0.035) * high * MM];
        const mark = new Mesh(new BoxGeometry(...size), new MeshBasicMaterial({ color: i === 0 ? 0xc2410c : 0x1f2937 }));
        const holder = new Group();
        mark.position.set(0.5 * (Math.max(...xs) + Math.min(...xs)) * MM, (race === 'inner' ? rim + 0.5 * depth + 0.01 * (high - low) : rim - 0.5 * depth - 0.01 * (high - low)) * MM, 0);
        holder.rotation.x = (i * Math.PI) / 2;
        holder.add(mark);
        marks.add(holder);
      }
      group.add(ring, marks);
      this.scene.add(group);
      this.rings[race] = { group, ring, marks };
    }
    const R = 0.5 * bearing.ball_diameter * MM;
    const sphere = new SphereGeometry(R, 48, 24);
    const surface = new MeshStandardMaterial({ map: ballTexture(), metalness: 0.15, roughness: 0.35 });
    const disc = new CircleGeometry(1, 48);
    const shaft = new CylinderGeometry(0.075 * R, 0.075 * R, 1, 16), tip = new ConeGeometry(0.2 * R, 0.42 * R, 20);
    this.balls = Array.from({ length: bearing.balls }, () => {
      const ball = new Mesh(sphere, surface);
      const contacts = ['inner', 'outer'].map(race => {
        const material = new MeshBasicMaterial({ color: 0xffffff });
        const ellipse = new Mesh(disc, new MeshBasicMaterial({ color: 0xffffff, side: DoubleSide }));
        const arrow = new Group();
        arrow.add(new Mesh(shaft, material), new Mesh(tip, material));
        this.scene.add(ellipse, arrow);
        return { race, ellipse, arrow, material };
      });
      this.scene.add(ball);
      return { ball, contacts };
    });
    if (bearing.cage) {
      this.cage = this.cageMesh(cageSection(bearing));
      this.scene.add(this.cage);
    }
    // Ellipses are enlarged until they can be seen.
    const axes = ['inner', 'outer'].flatMap(race => this.run.ofBalls(`${race}.semi_axis_transverse`).map(name => this.run.range(name)[1]));
    const most = Math.max(...axes, 0) * MM;
    this.enlarged = most > 0 ? Math.max(1, Math.round((0.42 * R) / most)) : 1;
    this.radius = Math.max(...sections.outer.map(p => p[1])) * MM;
  }

  /** A cage of two rings and bars between the pockets. */
  cageMesh({ inside, outside, half, pocket }) {
    const { bearing } = this.run;
    const group = new Group();
    const brass = new MeshStandardMaterial({ color: 0xb8922f, metalness: 0.4, roughness: 0.45, side: DoubleSide });
    for (const side of [-1, 1]) {
      const section = [[side * pocket, inside], [side * half, inside], [side * half, outside], [side * pocket, outside], [side * pocket, inside]];
      const ring = new Mesh(new LatheGeometry(section.map(([x, r]) => new Vector2(r * MM, -x * MM)), 96), brass);
      ring.rotation.z = Math.PI / 2;
      group.add(ring);
    }
    const middle = 0.5 * (inside + outside);
    const width = (2 * Math.PI * middle) / bearing.balls - 2 * pocket;
    if (width > 0) for (let i = 0; i < bearing.balls; i++) {
      const bar = new Mesh(new BoxGeometry(2 * half * MM, (outside - inside) * 0.94 * MM, width * MM), brass);
      const holder = new Group();
      bar.position.y = middle * MM;
      holder.rotation.x = bearing.first_ball_azimuth + (2 * Math.PI * (i + 0.5)) / bearing.balls;
      holder.add(bar);
      group.add(holder);
    }
    return group;
  }

  /** Orientations of the balls at all rows: their angular velocities, integrated. */
  orient() {
    const { run } = this;
    const t = run.times;
    const column = name => run.history.columns.get(name)?.values;
    this.turns = this.balls.map((_, ball) => {
      const w = ['x', 'y', 'z'].map(axis => column(`ball[${ball + 1}].angular_velocity.${axis}`));
      if (w.some(values => !values)) return null;
      const quaternions = new Float32Array(4 * t.length);
      const q = new Quaternion(), step = new Quaternion(), axis = new Vector3();
      for (let i = 0; i < t.length; i++) {
        if (i > 0) {
          axis.set(...w.map(values => 0.5 * (values[i] + values[i - 1])));
          const speed = axis.length();
          if (speed > 0) q.premultiply(step.setFromAxisAngle(axis.divideScalar(speed), speed * (t[i] - t[i - 1]))).normalize();
        }
        q.toArray(quaternions, 4 * i);
      }
      return { w, quaternions };
    });
  }

  colours() {
    this.scene.background = new Color(css('--stage'));
  }

  fit() {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    if (!width || !height) return;
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    this.update();
  }

  /** Cameras. z is up. */
  place() {
    const far = (1.2 * this.radius) / Math.tan((16 * Math.PI) / 180);
    this.camera.up.set(0, 0, 1);
    const direction = { free: [0.72, 0.62, 0.42], front: [1, 0, 0.0001], side: [0.02, 1, 0.12], ball: [0.62, 0.72, 0.38] }[this.state.camera];
    const distance = this.state.camera === 'ball' ? 0.62 * far : far;
    this.camera.position.set(...direction).normalize().multiplyScalar(distance);
    this.controls.target.set(0, 0, 0);
    this.controls.update();
    this.update();
  }

  /** Everything at the time of the clock. */
  update() {
    const { run, state } = this;
    const time = clock.time;
    const { bearing } = run;
    const at = (name, other = 0) => { const value = run.at(name, time); return Number.isFinite(value) ? value : other; };
    const vector = (name, other = [0, 0, 0]) => new Vector3(...['x', 'y', 'z'].map((axis, i) => at(`${name}.${axis}`, other[i])));
    const pose = (group, name, turning) => {
      group.position.copy(vector(`${name}.position`)).multiplyScalar(MM * state.magnify);
      const axis = vector(`${name}.axis`, [1, 0, 0]);
      // Tilts are magnified as places are, as long as they are small.
      const tilt = new Quaternion().setFromUnitVectors(X, axis.normalize());
      group.quaternion.copy(tilt);
      if (turning) turning.rotation.x = at(`${name}.turned`);
    };
    for (const race of ['inner', 'outer']) {
      const { group, ring, marks } = this.rings[race];
      pose(group, race, marks);
      group.visible = state.races;
      ring.rotation.x = CUTS;
      // Marks in the opening would hang in the air.
      for (const holder of marks.children) {
        const angle = (((marks.rotation.x + holder.rotation.x) % (2 * Math.PI)) + 2 * Math.PI) % (2 * Math.PI);
        holder.visible = angle > CUT;
      }
    }
    if (this.cage) {
      pose(this.cage, 'cage');
      this.cage.quaternion.multiply(new Quaternion().setFromAxisAngle(X, at('cage.turned')));
      this.cage.visible = state.cage;
    }
    const i = rowAt(run.times, time);
    const dt = time - run.times[i];
    const R = 0.5 * bearing.ball_diameter;
    const half = 0.5 * bearing.pitch_diameter;
    const loads = [];
    this.balls.forEach(({ ball, contacts }, index) => {
      const name = `ball[${index + 1}]`;
      const azimuth = run.azimuth(index + 1, time);
      const radial = new Vector3(0, Math.cos(azimuth), Math.sin(azimuth)), along = new Vector3(0, -Math.sin(azimuth), Math.cos(azimuth));
      const place = run.has(`${name}.position.x`) ? vector(`${name}.position`) : radial.clone().multiplyScalar(half);
      // Between rows balls go around, not along the chord.
      const radius = Math.hypot(place.y, place.z) || half;
      const centre = new Vector3(place.x, radius * Math.cos(azimuth), radius * Math.sin(azimuth));
      if (state.magnify > 1) centre.sub(radial.clone().multiplyScalar(half)).multiplyScalar(state.magnify).add(radial.clone().multiplyScalar(half));
      ball.position.copy(centre).multiplyScalar(MM);
      const turn = this.turns[index];
      if (turn) {
        ball.quaternion.fromArray(turn.quaternions, 4 * i);
        const w = new Vector3(...turn.w.map(values => values[i]));
        const speed = w.length();
        if (dt > 0 && speed > 0) ball.quaternion.premultiply(new Quaternion().setFromAxisAngle(w.divideScalar(speed), speed * dt));
      }
      for (const { race, ellipse, arrow, material } of contacts) {
        const load = at(`${name}.${race}.load`), angle = at(`${name}.${race}.contact_angle`);
        loads.push(load);
        const side = race === 'inner' ? -1 : 1;
        // From the ball's centre to the contact.
        const normal = radial.clone().multiplyScalar(side * Math.cos(angle)).add(X.clone().multiplyScalar(side * Math.sin(angle)));
        const share = load / this.mostLoad;
        const [r, g, b] = viridis(share);
        material.color.setRGB(r, g, b, SRGBColorSpace);
        ellipse.material.color.setRGB(r, g, b, SRGBColorSpace);
        const contact = ball.position.clone().addScaledVector(normal, R * MM);
        const transverse = new Vector3().crossVectors(normal, along);
        const [a, t] = ['rolling', 'transverse'].map(axis => at(`${name}.${race}.semi_axis_${axis}`) * MM * this.enlarged);
        ellipse.visible = state.ellipses && load > 0 && a > 0;
        if (ellipse.visible) {
          ellipse.matrixAutoUpdate = false;
          ellipse.matrix.makeBasis(along.clone().multiplyScalar(a), transverse.clone().multiplyScalar(t), normal.clone()).setPosition(contact.clone().addScaledVector(normal, 0.012 * R * MM));
        }
        arrow.visible = state.arrows && share > 1e-3;
        if (arrow.visible) {
          // The force of the race on the ball points to the ball's centre.
          const length = (0.35 + 1.5 * share) * R * MM;
          const [body, tip] = arrow.children;
          const into = normal.clone().negate();
          arrow.position.copy(contact);
          arrow.quaternion.setFromUnitVectors(new Vector3(0, 1, 0), into);
          const head = 0.42 * R * MM;
          const shaft = Math.max(length - head, 0.01);
          body.scale.y = shaft;
          body.position.y = -head - shaft / 2;
          tip.position.y = -head / 2;
        }
      }
    });
    const largest = Math.max(...loads);
    this.words.textContent = `t = ${digits(time * 1e3, 5)} ms \u00b7 largest ball load ${digits(largest, 4)} N \u00b7 ellipses enlarged \u00d7 ${this.enlarged}${state.magnify > 1 ? ` \u00b7 displacements \u00d7 ${state.magnify}` : ''} \u00b7 arrows: forces of the races on the balls`;
    if (this.state.camera === 'ball') {
      // The camera goes around with the cage.
      const turned = this.run.azimuth(1, time);
      const first = this.lastAzimuth ?? turned;
      this.camera.position.applyAxisAngle(X, turned - first);
      this.camera.up.applyAxisAngle(X, turned - first);
      this.lastAzimuth = turned;
      this.camera.lookAt(this.controls.target);
    } else this.lastAzimuth = undefined;
    this.render();
  }

  render() {
    this.renderer.render(this.scene, this.camera);
  }
}

/** Turn of the cut about the axis, so that it opens between +y and +z, where the camera stands. */
const CUTS = -Math.PI / 2;
