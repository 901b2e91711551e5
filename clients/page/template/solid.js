/* The surfaces of shapes: corners in body coordinates, triangles and edges as indices of corners. */

const SHAPE_CUBOID = 1, SHAPE_BOX = 4, SHAPE_HULL = 5;

/* number * 2^exponent, also where 2^exponent is no double. */
function scaled(number, exponent) {
    const half = Math.trunc(exponent / 2);
    return number * 2 ** half * 2 ** (exponent - half);
}

const sum = (a, b, factor = 1) => a.clone().addScaledVector(b, factor);
const units = [[1, 0, 0], [0, 1, 0], [0, 0, 1]].map((unit) => new THREE.Vector3(...unit));

/* Corner k of a cuboid is the origin plus the components i whose bit i of k is set. */
function cuboidOf(origin, components) {
    const corners = [origin], triangles = [], edges = [], bits = components.map((_, i) => 1 << i);
    components.forEach((component) => corners.push(...corners.map((corner) => sum(corner, component))));
    corners.forEach((_, k) => bits.filter((i) => !(k & i)).forEach((i) => {
        edges.push([k, k | i]);
        bits.filter((j) => j > i && !(k & j)).forEach((j) => triangles.push([k, k | i, k | i | j], [k, k | j, k | i | j]));
    }));
    return { corners, triangles, edges };
}

/* An axis-aligned box from its lowest corner. */
function boxOf(low, size, dim = 3) {
    return cuboidOf(low, units.slice(0, dim).map((unit) => unit.clone().multiply(size)));
}

function simplexOf(corners) {
    const all = corners.map((_, k) => k);
    return {
        corners, triangles: corners.length < 4 ? [all] : all.map((left) => all.filter((k) => k !== left)),
        edges: all.flatMap((a) => all.slice(0, a).map((b) => [a, b])),
    };
}

/* Adds orthogonal axes of length 1 until what the vectors have beside them is no longer than `limit`. */
function addAxes(axes, vectors, limit) {
    let rest = vectors;
    const remove = (axis) => { rest = rest.map((vector) => sum(vector, axis, -vector.dot(axis))); };
    axes.forEach(remove);
    for (;;) {
        const longest = rest.reduce((a, b) => b.lengthSq() > a.lengthSq() ? b : a);
        if (!(longest.length() > limit))
            return axes;
        axes.push(longest.clone().normalize());
        remove(axes[axes.length - 1]);
    }
}

/* A hull by three.js, which needs a solid: points in a plane, on a line or in one place get tips in the
 * directions that they do not span, and what has a tip is left out. */
function hullOf(corners) {
    const vectors = corners.map((corner) => sum(corner, corners[0], -1)), size = Math.max(...vectors.map((vector) => vector.length())) || 1;
    const points = vectors.map((vector) => vector.divideScalar(size)), axes = addAxes([], points, 1e-6), { length } = axes;
    const tips = addAxes(axes, units, 0.5).slice(length);
    const index = new Map(points.map((point, k) => [point, k])), triangles = [], edges = [];
    for (const face of new THREE.ConvexHull().setFromPoints([...points, ...tips]).faces) {
        const sides = [0, 1, 2].map((i) => face.getEdge(i));
        triangles.push(sides.map((side) => index.get(side.head().point)));
        edges.push(...sides.filter((side) => side.twin.face.normal.dot(face.normal) < 0.9998) /* not flat */
            .map((side) => [index.get(side.tail().point), index.get(side.head().point)]).filter(([a, b]) => a < b));
    }
    return { corners, triangles: triangles.filter((ends) => !ends.includes(undefined)), edges };
}

/* ---- Shapes ---- */

/* A frame of numbers, in units of 2^unit: its shape, whether they are vertices, their count, and they. */
function frameOf([shape, byVertices, , ...numbers], dim, unit) {
    const points = [];
    for (let at = 0; at < numbers.length; at += dim)
        points.push(new THREE.Vector3(...[0, 1, 2].map((axis) => axis < dim ? scaled(numbers[at + axis], -unit) : 0)));
    const [origin, ...rest] = points;
    if (shape === SHAPE_HULL)
        return hullOf(points);
    if (shape === SHAPE_BOX)
        return boxOf(sum(origin, rest[0], -0.5), rest[0], dim);
    return shape === SHAPE_CUBOID ? cuboidOf(origin, rest) : simplexOf(byVertices ? points : [origin, ...rest.map((component) => sum(origin, component))]);
}

/* A mesh: three corners for each triangle, so that each has the colour of its verdict; no edges. */
function meshOf(shape, unit) {
    const centre = shape.centre.map((x) => scaled(x, -unit)), factor = scaled(1, shape.at - 24 - unit);
    const first = shape.first + 3 * shape.corners, last = first + 3 * shape.faces, corners = [];
    for (const k of numbers.subarray(first, last))
        corners.push(new THREE.Vector3(...centre.map((x, axis) => x + factor * numbers[shape.first + 3 * k + axis])));
    return {
        corners, triangles: Array.from({ length: shape.faces }, (_, i) => [3 * i, 3 * i + 1, 3 * i + 2]), edges: [],
        verdicts: numbers.subarray(last, last + shape.faces),
    };
}

/* The frames of a shape, as lists of numbers. */
function framesOf({ frames = [] }) {
    const out = [];
    for (let at = 0; at < frames.length; at += out[out.length - 1].length)
        out.push(frames.slice(at, at + 3 + frames[at + 2]));
    return out;
}

/* The surface of a shape, in units of 2^unit. */
function solidOf(shape, unit) {
    if (shape.corners !== undefined)
        return meshOf(shape, unit);
    const solid = { corners: [], triangles: [], edges: [] };
    for (const numbers of framesOf(shape)) {
        const frame = frameOf(numbers, shape.dim, unit), first = solid.corners.length;
        frame.corners.forEach((corner) => solid.corners.push(corner));
        frame.triangles.forEach((triangle) => solid.triangles.push(triangle.map((k) => k + first)));
        frame.edges.forEach((edge) => solid.edges.push(edge.map((k) => k + first)));
    }
    return solid;
}

/* An exponent that bounds the coordinates of a shape: they are less than 2^exponent. */
function exponentOf(shape) {
    if (shape.exponent !== undefined)
        return shape.exponent;
    const numbers = [...shape.centre ?? [], ...framesOf(shape).flatMap((frame) => frame.slice(3))];
    const largest = numbers.reduce((most, x) => Math.max(most, Math.abs(x)), 0);
    shape.exponent = Math.max(largest > 0 ? Math.floor(Math.log2(largest)) + 3 : -1074, shape.at ?? -1074);
    return shape.exponent;
}
