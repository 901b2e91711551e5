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
const edges = { count: 0, x: new Float64Array(3), y: new Float64Array(3),
    slope: new Float64Array(3), down: new Uint8Array(3) };

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

/* p: 9 numbers, x and y in pixels and z towards the viewer of each corner. dots: it is seen, however
 * small it is. */
function fillFace(near, ids, id, p, dots) {
    const { width, height } = raster;
    const ax = p[0], ay = p[1], az = p[2];
    let bx = p[3], by = p[4], bz = p[5], cx = p[6], cy = p[7], cz = p[8];
    const left = Math.min(ax, bx, cx), right = Math.max(ax, bx, cx);
    const top = Math.min(ay, by, cy), bottom = Math.max(ay, by, cy);
    if (!(right >= 0 && left <= width && bottom >= 0 && top <= height))
        return;
    let area = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax);
    if (area < 0) {
        [bx, by, bz, cx, cy, cz] = [cx, cy, cz, bx, by, bz];
        area = -area;
    }
    let drawn = false;
    if (area > 1e-9) {
        const ux = bx - ax, uy = by - ay, uz = bz - az, vx = cx - ax, vy = cy - ay, vz = cz - az;
        const zx = (uz * vy - vz * uy) / area, zy = (vz * ux - uz * vx) / area;
        const first = Math.max(0, Math.ceil(top - 0.5));
        const last = Math.min(height - 1, Math.floor(bottom - 0.5));
        edges.count = 0;
        addEdge(ax, ay, bx, by);
        addEdge(bx, by, cx, cy);
        addEdge(cx, cy, ax, ay);
        for (let row = first; row <= last; row++) {
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
            let z = az + zx * (from + 0.5 - ax) + zy * (y - ay);
            for (let at = row * width + from, end = row * width + to; at <= end; at++, z += zx) {
                drawn = true;
                if (z > near[at]) {
                    near[at] = z;
                    ids[at] = id;
                }
            }
        }
    }
    if (!drawn && dots)
        fillDot(near, ids, id, (ax + bx + cx) / 3, (ay + by + cy) / 3, (az + bz + cz) / 3);
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
