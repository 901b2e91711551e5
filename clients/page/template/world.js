/* Converts frames and boxes to points for drawing.
 *
 * Numbers may have any magnitude. So coordinates are relative to the first body's position, and
 * scaled by a power of two such that all sums lie between -1 and 1. Both steps are nearly exact,
 * and neither overflows. Coordinates farther out, including infinite ends of boxes, are clamped. */

const CUT = 8;

/* Corner k of a cuboid adds component i if bit i of k is set. Corner 0 of a simplex is the origin,
 * corner i + 1 the end of component i. */
const CUBOID_3D = [[0, 2, 6, 4], [1, 3, 7, 5], [0, 1, 5, 4], [2, 3, 7, 6], [0, 1, 3, 2],
    [4, 5, 7, 6]];
const CUBOID_2D = [[0, 1, 3, 2]];
const TETRAHEDRON = [[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 2, 3]];
const TRIANGLE = [[0, 1, 2]];

function facesOf(dim, shape) {
    const solid = dim === 3 && shape !== FACE;
    if (shape === CUBOID)
        return solid ? CUBOID_3D : CUBOID_2D;
    return solid ? TETRAHEDRON : TRIANGLE;
}

function finite(value) {
    return value === Infinity ? Number.MAX_VALUE : value === -Infinity ? -Number.MAX_VALUE : value;
}

/* ---- Units ---- */

function largestOf(frames, T, origin) {
    let largest = 0;
    const add = (value) => {
        largest = Math.max(largest, Math.abs(finite(value)));
    };
    for (const frame of frames) {
        frame.position.forEach((value, axis) => add(value - origin[axis]));
        frame.shape.frames.forEach(([, ...numbers]) => numbers.forEach(add));
        (frame.velocity ?? []).forEach((value) => add(value * T));
    }
    return largest;
}

/* 2^power as two factors that are finite and not 0. */
function factors(power) {
    const half = Math.trunc(power / 2);
    return [2 ** half, 2 ** (power - half)];
}

/* The units for the drawable bodies of an event. The scale leaves space for a sum of some dozen
 * numbers of the largest magnitude to stay below 1. */
function makeUnits(dim, frames, T) {
    const origin = frames[0].position, largest = largestOf(frames, T, origin);
    const power = largest > 0 ? -Math.floor(Math.log2(largest)) - 5 : 0;
    return { dim, origin, power, factor: factors(power) };
}

/* Converts a length. */
function scaled(units, value) {
    return clamp(finite(value) * units.factor[0] * units.factor[1], -CUT, CUT);
}

/* Converts a coordinate. */
function placed(units, value, axis) {
    const difference = value - units.origin[axis];
    if (Number.isFinite(difference))
        return scaled(units, difference);
    return scaled(units, value) - scaled(units, units.origin[axis]);
}

/* Converts back to a length of the world; may be infinite or 0 for extreme units. */
function unscaled(units, value) {
    return value / units.factor[0] / units.factor[1];
}

/* ---- Outlines ---- */

function cornerAdds(shape, corner, component) {
    return shape === CUBOID ? (corner >> component) & 1 : corner === component + 1;
}

/* The corners of a frame in body coordinates, scaled: [x, y, z]. */
function bodyCorners(units, dim, [shape, ...numbers]) {
    const count = numbers.length / dim - 1, corners = [];
    const number = shape === CUBOID ? 1 << count : count + 1;
    for (let k = 0; k < number; k++) {
        const corner = [0, 0, 0];
        for (let axis = 0; axis < dim; axis++) {
            corner[axis] = scaled(units, numbers[axis]);
            for (let i = 0; i < count; i++)
                corner[axis] += cornerAdds(shape, k, i)
                    ? scaled(units, numbers[(i + 1) * dim + axis]) : 0;
        }
        corners.push(corner);
    }
    return corners;
}

function middleOf(points) {
    return [0, 1, 2].map((axis) => points.reduce((sum, point) => sum + point[axis], 0)
        / points.length);
}

/* A corner of a body in the world at the begin of the window; z = 0 in 2D. */
function placeCorner(units, body, corner) {
    const out = [0, 0, 0];
    for (let axis = 0; axis < body.shape.dim; axis++) {
        let at = placed(units, body.position[axis], axis);
        at += body.rotation ? dot(body.rotation[axis], corner) : corner[axis];
        out[axis] = clamp(at, -CUT, CUT);
    }
    return out;
}

/* The displacement of a body during the window. */
function shiftOf(units, body, T) {
    return [0, 1, 2].map((axis) => body.velocity && T > 0
        ? scaled(units, (body.velocity[axis] ?? 0) * T) : 0);
}

/* All frames of a body at the begin of the window. faces: indices of corners; shift: displacement
 * during the window. */
function outlineOf(units, body, T) {
    const { dim, frames } = body.shape, corners = [], faces = [];
    for (const given of frames) {
        const frame = cuboidOf(dim, given), first = corners.length;
        corners.push(...bodyCorners(units, dim, frame).map((corner) =>
            placeCorner(units, body, corner)));
        faces.push(...facesOf(dim, frame[0]).map((face) => face.map((k) => first + k)));
    }
    return { corners, faces, middle: middleOf(corners), shift: shiftOf(units, body, T) };
}

/* The corners at a moment of the window, 0 to 1. */
function cornersAt({ corners, shift }, moment) {
    return corners.map((corner) => plus(corner, shift, moment));
}

/* Converts an end of a box, which is null if infinite, and a word if NaN. */
function boxEnd(units, value, axis, sign) {
    return typeof value === "number" ? placed(units, value, axis) : sign * CUT;
}

function outlineOfBox(units, box) {
    const corners = [];
    for (let k = 0; k < 1 << units.dim; k++) {
        const corner = [0, 0, 0];
        for (let axis = 0; axis < units.dim; axis++) {
            const high = (k >> axis) & 1;
            corner[axis] = clamp(boxEnd(units, box[high][axis], axis, high ? 1 : -1), -CUT, CUT);
        }
        corners.push(corner);
    }
    return { corners, faces: units.dim === 3 ? CUBOID_3D : CUBOID_2D, middle: middleOf(corners) };
}

/* ---- Bounds: the extreme points in a set of directions ---- */

/* Directions with integer components from -2 to 2, without multiples: the axes and 92 others. */
const DIRECTIONS = [];
for (let k = 0; k < 125; k++) {
    const direction = [k % 5 - 2, Math.floor(k / 5) % 5 - 2, Math.floor(k / 25) - 2];
    if (direction.some((part) => Math.abs(part) === 1))
        DIRECTIONS.push(direction);
}

function boundsOfPoints(points) {
    const far = DIRECTIONS.map(() => -Infinity), extreme = DIRECTIONS.map(() => null);
    for (const point of points) {
        DIRECTIONS.forEach((direction, k) => {
            const way = dot(point, direction);
            if (way > far[k])
                [far[k], extreme[k]] = [way, point];
        });
    }
    const kept = [...new Set(extreme)], along = (axis) => kept.map((point) => point[axis]);
    return {
        points: kept, low: [0, 1, 2].map((axis) => Math.min(...along(axis))),
        high: [0, 1, 2].map((axis) => Math.max(...along(axis))),
    };
}

/* The bounds of one or more frames over the window. */
function boundsOf(units, frames, T) {
    return boundsOfPoints(frames.map((frame) => outlineOf(units, frame, T))
        .flatMap((outline) => [...outline.corners, ...cornersAt(outline, 1)]));
}

function extent(bounds) {
    return Math.max(...[0, 1, 2].map((axis) => bounds.high[axis] - bounds.low[axis]));
}

/* ---- Projection ---- */

/* The initial view: from the front, the right and above. */
const OBLIQUE = { azimuth: -1.012, elevation: 0.419 };
const VIEWS = {
    oblique: OBLIQUE,
    x: { azimuth: 0, elevation: 0 },
    y: { azimuth: -Math.PI / 2, elevation: 0 },
    z: { azimuth: -Math.PI / 2, elevation: Math.PI / 2 },
};

/* Direction towards the light; unit length. */
const LIGHT = [0.36, -0.48, 0.8];

/* Returns a function that converts unit coordinates to right, up, and towards the viewer. */
function turn(dim, azimuth, elevation) {
    if (dim === 2)
        return (p) => [p[0], p[1], 0];
    const ca = Math.cos(azimuth), sa = Math.sin(azimuth);
    const ce = Math.cos(elevation), se = Math.sin(elevation);
    return (p) => {
        const forward = ca * p[0] + sa * p[1];
        return [-sa * p[0] + ca * p[1], ce * p[2] - se * forward, ce * forward + se * p[2]];
    };
}

function minus(a, b) {
    return [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
}

function plus(a, b, times) {
    return [a[0] + times * b[0], a[1] + times * b[1], a[2] + times * b[2]];
}

function cross(a, b) {
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
}

function dot(a, b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* How much a face points towards the light, 0 to 1. */
function lightOf(a, b, c) {
    const normal = cross(minus(b, a), minus(c, a)), length = Math.hypot(...normal);
    return length > 0 ? Math.abs(dot(normal, LIGHT)) / length : 0.5;
}

/* ---- Clipping: the canvas gets no coordinates far outside the picture ---- */

/* The part of a polygon with keep(point) >= 0. */
function clipSide(points, keep) {
    const kept = [];
    points.forEach((point, i) => {
        const before = points[(i + points.length - 1) % points.length];
        const a = keep(before), b = keep(point);
        if ((a < 0) !== (b < 0)) {
            const part = a / (a - b);
            kept.push([0, 1].map((axis) => before[axis] + part * (point[axis] - before[axis])));
        }
        if (b >= 0)
            kept.push(point);
    });
    return kept;
}

const CLIP_MARGIN = 40; /* pixels */

function clipPolygon(points, width, height) {
    const inside = points.every(([x, y]) => x > -CLIP_MARGIN && x < width + CLIP_MARGIN
        && y > -CLIP_MARGIN && y < height + CLIP_MARGIN);
    if (inside)
        return points;
    let kept = clipSide(points, (p) => p[0] + CLIP_MARGIN);
    kept = clipSide(kept, (p) => width + CLIP_MARGIN - p[0]);
    kept = clipSide(kept, (p) => p[1] + CLIP_MARGIN);
    return clipSide(kept, (p) => height + CLIP_MARGIN - p[1]);
}
