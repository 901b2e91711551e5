/* The surfaces of shapes: corners in body coordinates, triangles and edges. */

const SHAPE_CUBOID = 1, SHAPE_TETRAHEDRON = 2, SHAPE_FACE = 3, SHAPE_BOX = 4, SHAPE_HULL = 5;

/* number * 2^exponent, also where 2^exponent is no double. */
function scaled(number, exponent) {
    const half = Math.trunc(exponent / 2);
    return number * 2 ** half * 2 ** (exponent - half);
}

/* The point of a list of numbers at `at`; z is 0 in 2D. Numbers are multiplied by 2^-unit. */
function pointAt(numbers, at, dim, unitExponent) {
    return [0, 1, 2].map((axis) => axis < dim ? scaled(numbers[at + axis], -unitExponent) : 0);
}

const plus = (a, b, factor = 1) => a.map((x, axis) => x + factor * b[axis]);

/* Corner k of a cuboid is the origin plus the components i whose bit i of k is set. */
function cuboidOf(origin, components) {
    const flat = components.length === 2, corners = [];
    for (let k = 0; k < 1 << components.length; k++)
        corners.push(components.reduce((at, component, i) => k >> i & 1 ? plus(at, component) : at, origin));
    return flat ? { corners, triangles: [[0, 1, 3], [0, 3, 2]], edges: [[0, 1], [1, 3], [3, 2], [2, 0]] } : {
        corners,
        triangles: [[0, 2, 6, 4], [1, 5, 7, 3], [0, 4, 5, 1], [2, 3, 7, 6], [0, 1, 3, 2], [4, 6, 7, 5]]
            .flatMap(([a, b, c, d]) => [[a, b, c], [a, c, d]]),
        edges: [[0, 1], [2, 3], [4, 5], [6, 7], [0, 2], [1, 3], [4, 6], [5, 7], [0, 4], [1, 5], [2, 6], [3, 7]],
    };
}

function simplexOf(corners) {
    return corners.length === 4
        ? { corners, triangles: [[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 2, 3]], edges: [[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]] }
        : { corners, triangles: [[0, 1, 2]], edges: [[0, 1], [1, 2], [2, 0]] };
}

/* ---- Hulls ---- */

/* The polygon around points of a plane, by their coordinates on the axes x and y (monotone chain). */
function polygonOf(corners, x, y) {
    const sorted = [...corners].sort((a, b) => a[x] - b[x] || a[y] - b[y]);
    const half = (points) => {
        const chain = [];
        for (const p of points) {
            for (let n = chain.length; n > 1; n--) {
                const [a, b] = chain.slice(-2);
                if ((b[x] - a[x]) * (p[y] - a[y]) - (b[y] - a[y]) * (p[x] - a[x]) > 0)
                    break;
                chain.pop();
            }
            chain.push(p);
        }
        return chain.slice(0, -1);
    };
    const around = sorted.length > 1 ? [...half(sorted), ...half(sorted.reverse())] : sorted;
    return {
        corners: around,
        triangles: around.slice(2).map((_, i) => [0, i + 1, i + 2]),
        edges: around.map((_, i) => [i, (i + 1) % around.length]),
    };
}

function cross(a, b) {
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
}

const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];

/* A normal of the plane of all points; null: they are in no plane. Of points on a line any normal. */
function planeOf(corners) {
    let normal = [0, 0, 0], size = 0;
    const far = (from, length) => corners.reduce((best, p) => length(p) > length(best) ? p : best, from);
    const [a] = corners;
    const b = far(a, (p) => dot(plus(p, a, -1), plus(p, a, -1)));
    const along = plus(b, a, -1);
    for (const p of corners) {
        const by = cross(along, plus(p, a, -1));
        if (dot(by, by) > size) {
            normal = by;
            size = dot(by, by);
        }
    }
    const limit = 1e-6 * Math.sqrt(size * dot(along, along));
    return corners.every((p) => Math.abs(dot(normal, plus(p, a, -1))) <= limit) ? normal : null;
}

function hullOf(points, dim) {
    const corners = [...new Map(points.map((p) => [p.join(), p])).values()];
    if (dim === 2)
        return polygonOf(corners, 0, 1);
    const normal = planeOf(corners);
    if (normal) {
        const drop = normal.map(Math.abs).reduce((best, size, axis, sizes) => size > sizes[best] ? axis : best, 0);
        const axes = [0, 1, 2].filter((axis) => axis !== drop);
        /* of points on a line both axes may be the same for all */
        const spread = (axis) => Math.max(...corners.map((p) => p[axis])) - Math.min(...corners.map((p) => p[axis]));
        return dot(normal, normal) > 0 ? polygonOf(corners, ...axes)
            : polygonOf(corners, ...[0, 1, 2].sort((a, b) => spread(b) - spread(a)).slice(0, 2));
    }
    /* in units of the hull: three.js takes points closer than some 1e-16 for one */
    const size = Math.max(...corners.flat().map(Math.abs));
    const surface = new THREE.ConvexBufferGeometry(corners.map((p) => new THREE.Vector3(...p).divideScalar(size)));
    const list = (geometry) => {
        const { array, count } = geometry.attributes.position;
        return Array.from({ length: count }, (_, i) => [0, 1, 2].map((axis) => array[3 * i + axis] * size));
    };
    const faces = list(surface), lines = list(new THREE.EdgesGeometry(surface, 1));
    return {
        corners: [...faces, ...lines],
        triangles: Array.from({ length: faces.length / 3 }, (_, i) => [3 * i, 3 * i + 1, 3 * i + 2]),
        edges: Array.from({ length: lines.length / 2 }, (_, i) => [0, 1].map((k) => faces.length + 2 * i + k)),
    };
}

/* ---- Shapes ---- */

/* One frame of a shape: numbers[at...] are shape, whether by vertices, count, numbers. */
function frameOf(numbers, at, dim, unitExponent) {
    const [shape, byVertices, count] = numbers.slice(at, at + 3);
    const points = Array.from({ length: count / dim }, (_, i) => pointAt(numbers, at + 3 + i * dim, dim, unitExponent));
    const [origin, ...rest] = points;
    if (shape === SHAPE_HULL)
        return hullOf(points, dim);
    if (shape === SHAPE_BOX) {
        const size = rest[0];
        return cuboidOf(plus(origin, size, -0.5), [0, 1, 2].slice(0, dim)
            .map((axis) => size.map((length, i) => i === axis ? length : 0)));
    }
    if (shape === SHAPE_CUBOID)
        return cuboidOf(origin, rest);
    return simplexOf(byVertices ? points : [origin, ...rest.map((component) => plus(origin, component))]);
}

/* A mesh: its corners, triangles, the verdict of each triangle, no edges. */
function meshOf(shape, unitExponent) {
    const centre = shape.centre.map((x) => scaled(x, -unitExponent)), factor = scaled(1, shape.at - 24 - unitExponent);
    const triples = (first, count, value) => Array.from({ length: count }, (_, i) => [0, 1, 2].map((k) => value(numbers[first + 3 * i + k], k)));
    const first = shape.first + 3 * shape.corners, last = first + 3 * shape.faces;
    return {
        corners: triples(shape.first, shape.corners, (x, axis) => centre[axis] + factor * x), triangles: triples(first, shape.faces, (k) => k),
        edges: [], verdicts: numbers.subarray(last, last + shape.faces),
    };
}

/* The surface of a shape, in units of 2^unitExponent. */
function solidOf(shape, unitExponent) {
    if (shape.corners !== undefined)
        return meshOf(shape, unitExponent);
    const solid = { corners: [], triangles: [], edges: [] };
    for (let at = 0; at < shape.frames.length; at += 3 + shape.frames[at + 2]) {
        const frame = frameOf(shape.frames, at, shape.dim, unitExponent), first = solid.corners.length;
        frame.corners.forEach((corner) => solid.corners.push(corner));
        frame.triangles.forEach((triangle) => solid.triangles.push(triangle.map((k) => k + first)));
        frame.edges.forEach((edge) => solid.edges.push(edge.map((k) => k + first)));
    }
    return solid;
}

/* An exponent that bounds the coordinates of a shape: they are less than 2^exponent. */
function exponentOf(shape) {
    let largest = Math.max(...(shape.centre ?? [0]).map(Math.abs));
    for (let at = 0; at < shape.frames?.length; at += 3 + shape.frames[at + 2])
        largest = shape.frames.slice(at + 3, at + 3 + shape.frames[at + 2]).reduce((most, x) => Math.max(most, Math.abs(x)), largest);
    return Math.max(largest > 0 ? Math.floor(Math.log2(largest)) + 3 : -1074, shape.at ?? -1074);
}
