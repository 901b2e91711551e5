/* Faces on a grid of pixels: there are layers, for what does not meet of each mesh and for what
 * does, and each has at each pixel the face that is nearest, and how near it is. It needs nothing
 * of the machine but its processor, and shows the same everywhere. */

const LAYERS = 3, MET_LAYER = 2;
const NO_FACE = -1;

const raster = { width: 0, height: 0, near: [], id: [] };

function sizeRaster(width, height) {
    if (raster.width === width && raster.height === height)
        return;
    Object.assign(raster, { width, height, near: [], id: [] });
    for (let k = 0; k < LAYERS; k++) {
        raster.near.push(new Float32Array(width * height));
        raster.id.push(new Int32Array(width * height));
    }
}

function clearRaster() {
    for (let k = 0; k < LAYERS; k++) {
        raster.near[k].fill(-Infinity);
        raster.id[k].fill(NO_FACE);
    }
}

/* What is too small to cover the middle of a pixel: where its neighbours are not drawn, a crowd of
 * dots is still seen as what it is. */
function fillDot(near, ids, id, x, y, z) {
    const column = Math.floor(x), row = Math.floor(y);
    if (column < 0 || row < 0 || column >= raster.width || row >= raster.height)
        return;
    const at = row * raster.width + column;
    if (z > near[at]) {
        near[at] = z;
        ids[at] = id;
    }
}

/* The edges of a face that are not level. In a row at y the face lies between those that go down,
 * on its right, and those that go up; each is at x + slope * (y - its y). */
const edges = {
    count: 0, x: new Float64Array(3), y: new Float64Array(3), slope: new Float64Array(3),
    down: new Uint8Array(3),
};

/* Of the edge from p to q of a face whose corners go around clockwise, as it is seen. */
function addEdge(px, py, qx, qy) {
    const { count } = edges;
    if (qy === py)
        return;
    edges.x[count] = px;
    edges.y[count] = py;
    edges.slope[count] = (qx - px) / (qy - py);
    edges.down[count] = qy > py ? 1 : 0;
    edges.count = count + 1;
}

/* The change of depth from pixel to pixel: across, and down. ux and uy are the way from the first
 * corner to the second, vx and vy that to the third, area is twice the face's. */
function slopes(p, ux, uy, vx, vy, area) {
    const uz = p[5] - p[2], vz = p[8] - p[2];
    return [(uz * vy - vz * uy) / area, (vz * ux - uz * vx) / area];
}

/* True where the face covers the middle of a pixel. */
function fillRows(near, ids, id, p, [across, down]) {
    const { width, height } = raster;
    const left = Math.min(p[0], p[3], p[6]), right = Math.max(p[0], p[3], p[6]);
    const top = Math.max(0, Math.ceil(Math.min(p[1], p[4], p[7]) - 0.5));
    const bottom = Math.min(height - 1, Math.floor(Math.max(p[1], p[4], p[7]) - 0.5));
    let drawn = false;
    for (let row = top; row <= bottom; row++) {
        const y = row + 0.5;
        let low = left, high = right;
        for (let k = 0; k < edges.count; k++) {
            const x = edges.x[k] + edges.slope[k] * (y - edges.y[k]);
            if (edges.down[k])
                high = x < high ? x : high;
            else
                low = x > low ? x : low;
        }
        const from = Math.max(0, Math.ceil(low - 0.5));
        const to = Math.min(width - 1, Math.floor(high - 0.5));
        let z = p[2] + across * (from + 0.5 - p[0]) + down * (y - p[1]);
        for (let at = row * width + from, end = row * width + to; at <= end; at++, z += across) {
            drawn = true;
            if (z > near[at]) {
                near[at] = z;
                ids[at] = id;
            }
        }
    }
    return drawn;
}

function isOutside(p) {
    const { width, height } = raster;
    return !(Math.max(p[0], p[3], p[6]) >= 0 && Math.min(p[0], p[3], p[6]) <= width
        && Math.max(p[1], p[4], p[7]) >= 0 && Math.min(p[1], p[4], p[7]) <= height);
}

const FLAT = 1e-9; /* square pixels */

/* p: 9 numbers, x and y in pixels and z towards the viewer of each corner. dots: it is seen,
 * however small it is. */
function fillFace(near, ids, id, p, dots) {
    if (isOutside(p))
        return;
    const ux = p[3] - p[0], uy = p[4] - p[1], vx = p[6] - p[0], vy = p[7] - p[1];
    const area = ux * vy - uy * vx;
    let drawn = false;
    if (Math.abs(area) > FLAT) {
        const second = area > 0 ? 3 : 6, third = 9 - second; /* clockwise */
        edges.count = 0;
        addEdge(p[0], p[1], p[second], p[second + 1]);
        addEdge(p[second], p[second + 1], p[third], p[third + 1]);
        addEdge(p[third], p[third + 1], p[0], p[1]);
        drawn = fillRows(near, ids, id, p, slopes(p, ux, uy, vx, vy, area));
    }
    if (!drawn && dots)
        fillDot(near, ids, id, (p[0] + p[3] + p[6]) / 3, (p[1] + p[4] + p[7]) / 3,
            (p[2] + p[5] + p[8]) / 3);
}

/* Where the mesh's vertices are, in pixels of the raster: rows of a matrix with a shift. */
function projectMesh(mesh, rows) {
    const { corner } = mesh, count = corner.length;
    mesh.seen ??= new Float64Array(count);
    for (let i = 0; i < count; i += 3) {
        const x = corner[i], y = corner[i + 1], z = corner[i + 2];
        mesh.seen[i] = rows[0] * x + rows[1] * y + rows[2] * z + rows[3];
        mesh.seen[i + 1] = rows[4] * x + rows[5] * y + rows[6] * z + rows[7];
        mesh.seen[i + 2] = rows[8] * x + rows[9] * y + rows[10] * z + rows[11];
    }
}

/* The matrix, of what project() does to points. */
function rowsOf(project, scale, shift) {
    const rows = new Float64Array(12), origin = project(shift);
    for (let axis = 0; axis < 3; axis++) {
        const along = project(shift.map((value, i) => value + (i === axis ? 1 : 0)));
        for (let row = 0; row < 3; row++)
            rows[4 * row + axis] = (along[row] - origin[row]) * (row < 2 ? scale : 1);
    }
    for (let row = 0; row < 3; row++)
        rows[4 * row + 3] = origin[row] * (row < 2 ? scale : 1);
    return rows;
}

const corners = new Float64Array(9);

function rasterise(mesh, project, scale, moment) {
    projectMesh(mesh, rowsOf(project, scale, mesh.shift.map((value) => value * moment)));
    const { face, seen, colour } = mesh;
    for (let f = 0; f < colour.length; f++) {
        for (let k = 0; k < 3; k++) {
            const from = 3 * face[3 * f + k];
            corners[3 * k] = seen[from];
            corners[3 * k + 1] = seen[from + 1];
            corners[3 * k + 2] = seen[from + 2];
        }
        const layer = colour[f] ? MET_LAYER : mesh.index;
        const dots = layer === MET_LAYER || mesh.number !== null;
        fillFace(raster.near[layer], raster.id[layer], mesh.first + f, corners, dots);
    }
}

/* The face that is seen at a place: one that meets before others. */
function faceAt(column, row) {
    if (column < 0 || row < 0 || column >= raster.width || row >= raster.height)
        return NO_FACE;
    const at = row * raster.width + column, { near, id } = raster;
    if (id[MET_LAYER][at] !== NO_FACE)
        return id[MET_LAYER][at];
    return near[0][at] >= near[1][at] ? id[0][at] : id[1][at];
}
