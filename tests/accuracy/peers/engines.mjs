// Runs scenes in an engine from npm: node engines.mjs box2d3|rapier FOLDER OUTPUT. FOLDER/node_modules has the packages.
// Reads commands on stdin, one a line. ID is any name for a scene:
//   scene ID GRAVITY_X GRAVITY_Y MAY_SLEEP
//   body ID MOTION X Y ANGLE VELOCITY_X VELOCITY_Y SPIN MASS INERTIA FAST DRAG
//   shape ID X Y FRICTION RESTITUTION SIZE...          of the last body: a radius, or half a width and a height
//   joint ID KIND A B X_A Y_A X_B Y_B STIFFNESS DAMPING REST_LENGTH
//   step ID H COUNT [ACCELERATION_X ACCELERATION_Y]... COUNT steps of H seconds; an acceleration for each body, or none
//   free ID
// MOTION and KIND are numbers of the enumerations in Scene.h. Inertia 0: the body does not rotate. A = -1: the ground.
// Answers `step` with doubles on the descriptor OUTPUT: how many contacts have begun, and each body's x, y, velocity x, y,
// angle and spin.
import {writeSync} from "node:fs";
import {createInterface} from "node:readline";
import {pathToFileURL} from "node:url";

const DYNAMIC = 2, HINGE = 1, SPRING = 2;
const [, , engine, folder, output] = process.argv;
const load = (path) => import(pathToFileURL(`${folder}/node_modules/${path}`));

// Box2D v3 with its defaults; a step has 4 sub-steps.
async function box2d3() {
  const b2 = await (await load("box2d3-wasm/build/dist/es/compat/Box2D.compat.mjs")).default();
  const {b2_staticBody, b2_kinematicBody, b2_dynamicBody} = b2.b2BodyType;
  const scratch = new b2.b2Vec2();
  const vector = (x, y) => scratch.Set(x, y);  // calls and properties copy it

  return class {
    contacts = 0;
    bodies = [];
    masses = [];  // of dynamic bodies, else 0

    constructor(x, y, maySleep) {
      const definition = b2.b2DefaultWorldDef();
      definition.gravity.Set(x, y);
      definition.enableSleep = maySleep === 1;
      this.world = b2.b2CreateWorld(definition);
      this.ground = b2.b2CreateBody(this.world, b2.b2DefaultBodyDef());
    }
    body(motion, x, y, angle, vx, vy, spin, mass, inertia, fast, drag) {
      const definition = b2.b2DefaultBodyDef();
      const type = [b2_staticBody, b2_kinematicBody, b2_dynamicBody][motion];
      Object.assign(definition, {type, angularVelocity: spin, linearDamping: drag / mass, isBullet: fast === 1});
      definition.position.Set(x, y);
      definition.linearVelocity.Set(vx, vy);
      Object.assign(definition.rotation, {c: Math.cos(angle), s: Math.sin(angle)});
      definition.motionLocks.angularZ = motion === DYNAMIC && inertia === 0;
      const id = b2.b2CreateBody(this.world, definition);
      this.bodies.push(id);
      this.masses.push(motion === DYNAMIC ? mass : 0);
      if (motion === DYNAMIC) b2.b2Body_SetMassData(id, Object.assign(new b2.b2MassData(), {mass, rotationalInertia: inertia}));
    }
    shape(x, y, friction, restitution, ...size) {
      const definition = b2.b2DefaultShapeDef();
      Object.assign(definition.material, {friction, restitution});
      Object.assign(definition, {enableContactEvents: true, updateBodyMass: false});
      const id = this.bodies.at(-1);
      if (size.length === 2) {
        b2.b2CreatePolygonShape(id, definition, b2.b2MakeOffsetBox(...size, vector(x, y), b2.b2Rot_identity));
      } else {
        const circle = Object.assign(new b2.b2Circle(), {center: vector(x, y), radius: size[0]});
        b2.b2CreateCircleShape(id, definition, circle);
      }
    }
    joint(kind, a, b, ax, ay, bx, by, stiffness, damping, restLength) {
      const definition = kind === HINGE ? b2.b2DefaultRevoluteJointDef() : b2.b2DefaultDistanceJointDef();
      const base = definition.base;
      base.bodyIdA = this.bodies[a] ?? this.ground;
      base.bodyIdB = this.bodies[b];
      base.localFrameA.p = b2.b2Body_GetLocalPoint(base.bodyIdA, vector(ax, ay));
      base.localFrameB.p = b2.b2Body_GetLocalPoint(base.bodyIdB, vector(bx, by));
      if (kind !== HINGE) definition.length = Math.hypot(bx - ax, by - ay);
      if (kind === SPRING) {
        // A spring is given by the frequency and the damping ratio of the two masses.
        const inverse = (index) => this.masses[index] > 0 ? 1 / this.masses[index] : 0;
        const frequency = Math.sqrt(stiffness * (inverse(a) + inverse(b)));
        const dampingRatio = damping * frequency / (2 * stiffness);
        Object.assign(definition, {enableSpring: true, length: restLength, hertz: frequency / (2 * Math.PI), dampingRatio});
      }
      (kind === HINGE ? b2.b2CreateRevoluteJoint : b2.b2CreateDistanceJoint)(this.world, definition);
    }
    push(index, x, y) {
      const mass = this.masses[index];
      b2.b2Body_ApplyForceToCenter(this.bodies[index], vector(mass * x, mass * y), true);
    }
    step(h) {
      b2.b2World_Step(this.world, h, 4);
      const events = b2.b2World_GetContactEvents(this.world);
      this.contacts += events.beginCount;
      events.delete();
    }
    state(id) {
      const [p, v, q] = [b2.b2Body_GetPosition(id), b2.b2Body_GetLinearVelocity(id), b2.b2Body_GetRotation(id)];
      const state = [p.x, p.y, v.x, v.y, Math.atan2(q.s, q.c), b2.b2Body_GetAngularVelocity(id)];
      for (const handle of [p, v, q]) handle.delete();
      return state;
    }
    free() { b2.b2DestroyWorld(this.world); }
  };
}

// Rapier with its defaults: 4 solver iterations a step. It has no rods.
async function rapier() {
  const {default: rapier} = await load("@dimforge/rapier2d-deterministic-compat/dist/rapier.mjs");
  await rapier.init();
  const {ActiveEvents, CoefficientCombineRule, ColliderDesc, EventQueue, JointData, RigidBodyDesc, RigidBodyType} = rapier;

  return class {
    contacts = 0;
    bodies = [];
    masses = [];
    events = new EventQueue(true);

    constructor(x, y, maySleep) {
      this.world = new rapier.World({x, y});
      this.maySleep = maySleep === 1;
      this.ground = this.world.createRigidBody(RigidBodyDesc.fixed());
    }
    body(motion, x, y, angle, vx, vy, spin, mass, inertia, fast, drag) {
      const {Fixed, KinematicVelocityBased, Dynamic} = RigidBodyType;
      const definition = new RigidBodyDesc([Fixed, KinematicVelocityBased, Dynamic][motion])
        .setTranslation(x, y).setRotation(angle).setLinvel(vx, vy).setAngvel(spin)
        .setLinearDamping(drag / mass).setCcdEnabled(fast === 1).setCanSleep(this.maySleep);
      if (motion === DYNAMIC) definition.setAdditionalMassProperties(mass, {x: 0, y: 0}, inertia);
      if (motion === DYNAMIC && inertia === 0) definition.lockRotations();
      this.bodies.push(this.world.createRigidBody(definition));
      this.masses.push(motion === DYNAMIC ? mass : 0);
    }
    shape(x, y, friction, restitution, ...size) {
      const definition = size.length === 2 ? ColliderDesc.cuboid(...size) : ColliderDesc.ball(size[0]);
      // The product of the roots is the root of the product.
      definition.setFriction(Math.sqrt(friction)).setFrictionCombineRule(CoefficientCombineRule.Multiply)
        .setRestitution(restitution).setRestitutionCombineRule(CoefficientCombineRule.Max)
        .setTranslation(x, y).setDensity(0).setActiveEvents(ActiveEvents.COLLISION_EVENTS);
      this.world.createCollider(definition, this.bodies.at(-1));
    }
    joint(kind, a, b, ax, ay, bx, by, stiffness, damping, restLength) {
      const [first, second] = [this.bodies[a] ?? this.ground, this.bodies[b]];
      const local = (body, x, y) => {
        const {x: left, y: up} = body.translation();
        const [c, s] = [Math.cos(body.rotation()), Math.sin(body.rotation())];
        return {x: c * (x - left) + s * (y - up), y: c * (y - up) - s * (x - left)};
      };
      const anchors = [local(first, ax, ay), local(second, bx, by)];
      const data = kind === HINGE ? JointData.revolute(...anchors) : JointData.spring(restLength, stiffness, damping, ...anchors);
      this.world.createImpulseJoint(data, first, second, true);
    }
    push(index, x, y) {
      const mass = this.masses[index];
      this.bodies[index].resetForces(false);
      this.bodies[index].addForce({x: mass * x, y: mass * y}, true);
    }
    step(h) {
      this.world.timestep = h;
      this.world.step(this.events);
      this.events.drainCollisionEvents((a, b, started) => { this.contacts += started ? 1 : 0; });
    }
    state(body) {
      const [p, v] = [body.translation(), body.linvel()];
      return [p.x, p.y, v.x, v.y, body.rotation(), body.angvel()];
    }
    free() { [this.world, this.events].forEach((owned) => owned.free()); }
  };
}

function send(scene) {
  const numbers = [scene.contacts];
  for (const body of scene.bodies) numbers.push(...scene.state(body));
  const bytes = new Uint8Array(Float64Array.from(numbers).buffer);
  for (let sent = 0; sent < bytes.length;) sent += writeSync(Number(output), bytes, sent);
}

const EngineScene = await {box2d3, rapier}[engine]();
const scenes = new Map();
for await (const line of createInterface({input: process.stdin})) {
  const [command, id, ...words] = line.split(" ");
  const numbers = words.map((word) => Number(word.replace("inf", "Infinity")));
  const scene = scenes.get(id);
  if (command === "scene") {
    scenes.set(id, new EngineScene(...numbers));
  } else if (command === "step") {
    const [h, count, ...pushes] = numbers;
    for (let i = 0; i < count; ++i) {
      if (pushes.length > 0) scene.bodies.forEach((_, k) => scene.push(k, pushes[2 * k], pushes[2 * k + 1]));
      scene.step(h);
    }
    send(scene);
  } else if (command === "free") {
    scene.free();
    scenes.delete(id);
  } else {
    scene[command](...numbers);
  }
}
