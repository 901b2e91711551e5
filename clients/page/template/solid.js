/* The surfaces of shapes: corners in body coordinates, triangles and edges as indices of corners. */

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
        edges.push(...sides.filter((side) => side.twin.face.normal.dot(face.normal) < 0.94) /* by more than 20 degrees */
            .map((side) => [index.get(side.tail().point), index.get(side.head().point)]).filter(([a, b]) => a < b));
    }
    return { corners, triangles: triangles.filter((ends) => !ends.includes(undefined)), edges };
}

/* The set of points within a radius of the convex hull of corners. Its surface is made of the points of a sphere,
 * in 2D of a circle: each is moved by the corner that is farthest in its direction. The directions are shifted a
 * little, so that no two corners are equally far. Triangles are counterclockwise seen from outside. */
function roundOf(corners, radius, dim) {
    const turns = dim === 2 ? 64 : 32, rows = dim === 2 ? 0 : turns / 2, out = { corners: [], normals: [], triangles: [], edges: [] };
    const normalOf = (row, turn) => {
        const up = rows ? Math.cos(Math.PI * row / rows) : 0, flat = Math.sqrt(1 - up * up), angle = 2 * Math.PI * turn / turns;
        return new THREE.Vector3(flat * Math.cos(angle), flat * Math.sin(angle), up);
    };
    for (let k = 0; k < (rows + 1) * turns; k++) {
        const row = Math.floor(k / turns), turn = k % turns, next = k - turn + (turn + 1) % turns;
        const beside = normalOf(Math.min(row + 0.01, rows - 0.01), turn + 0.01);
        out.corners.push(sum(corners.reduce((a, b) => b.dot(beside) > a.dot(beside) ? b : a), normalOf(row, turn), radius));
        if (rows)
            out.normals.push(normalOf(row, turn));
        if (2 * row === rows)
            out.edges.push([k, next]);
        if (row === 0 || row === rows)
            out.triangles.push(row === 0 ? [k - turn, k, next] : [k - turn, next, k]);
        if (row < rows)
            out.triangles.push([next, k, k + turns], [next, k + turns, next + turns]);
        if (row < rows && turn % (turns / 4) === 0)
            out.edges.push([k, k + turns]);
    }
    return out;
}

/* ---- Shapes ---- */

/* A point of up to three coordinates, in units of 2^unit. */
const vectorOf = (numbers, unit) => new THREE.Vector3(...[0, 1, 2].map((axis) => scaled(numbers[axis] ?? 0, -unit)));

/* A frame of scenes without its radius, in units of 2^unit. */
function coreOf({ shape, origin, position, size, components = [], vertices, length }, dim, unit) {
    const at = vectorOf(origin ?? position ?? [], unit), edges = components.map((component) => vectorOf(component, unit));
    if (shape === "box") {
        const half = vectorOf(size, unit + 1);
        return boxOf(sum(at, half, -1), half.multiplyScalar(2), dim);
    }
    if (shape === "sphere")
        return { corners: [at] };
    if (shape === "capsule")
        return { corners: [-1, 1].map((side) => units[dim - 1].clone().multiplyScalar(scaled(side * length, -unit - 1))) };
    if (vertices)
        return (shape === "hull" ? hullOf : simplexOf)(vertices.map((vertex) => vectorOf(vertex, unit)));
    return shape === "cuboid" ? cuboidOf(at, edges) : simplexOf([at, ...edges.map((edge) => sum(at, edge))]);
}

function frameOf(frame, dim, unit) {
    const core = coreOf(frame, dim, unit);
    return frame.radius ? roundOf(core.corners, scaled(frame.radius, -unit), dim) : core;
}

/* The surface of a shape, in units of 2^unit. starts: the first corner of each frame; normals: of the corners of
 * round frames. */
function solidOf(shape, unit) {
    const solid = { corners: [], normals: [], triangles: [], edges: [], starts: [] };
    for (const given of shape.frames) {
        const frame = frameOf(given, shape.dim, unit), first = solid.corners.length;
        solid.starts.push(first);
        frame.normals?.forEach((normal, k) => { solid.normals[first + k] = normal; });
        frame.corners.forEach((corner) => solid.corners.push(corner));
        frame.triangles.forEach((triangle) => solid.triangles.push(triangle.map((k) => k + first)));
        if (shape.frames.length <= 1000) /* of more, edges would hide the faces */
            frame.edges.forEach((edge) => solid.edges.push(edge.map((k) => k + first)));
    }
    return solid;
}

/* An exponent that bounds numbers: they are less than 2^exponent. */
function exponentOfAll(numbers) {
    const largest = numbers.reduce((most, x) => Math.max(most, Math.abs(x)), 0);
    return largest > 0 ? Math.floor(Math.log2(Math.min(largest, Number.MAX_VALUE))) + 1 : -1074;
}

/* An exponent that bounds the coordinates of a shape. */
function exponentOf(shape) {
    shape.exponent ??= 2 + exponentOfAll(shape.frames
        .flatMap(({ origin, position, size, components, vertices, radius, length }) =>
            [origin ?? position ?? [], size ?? [], components ?? [], vertices ?? [], radius ?? 0, length ?? 0].flat(2)));
    return shape.exponent;
}
