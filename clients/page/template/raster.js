/* A software rasteriser. Faces belong to groups: a body, or the intersecting faces of a mesh. Each
 * pixel keeps the nearest face of each group, and of these the nearest SLOTS, sorted by depth. It
 * needs no graphics hardware, and gives the same picture everywhere. A 3D library would add some
 * 600 kB to each page, since a page is a single file that fetches nothing. */

const SLOTS = 4;
const NO_FACE = -1;
const SAME_DEPTH = 1e-6;    /* with nearly equal depths the face drawn first stays in front */

/* [pixel * SLOTS + slot]: depth towards the viewer, and id of the face. */
const raster = { width: 0, height: 0, near: null, id: null };

/* By the id of the face: red, green and blue, a byte each; opacity, 0 to 1; group. */
const faces = { shade: null, cover: null, group: null };

function allotFaces(count) {
    faces.shade = new Uint8Array(3 * count);
    faces.cover = new Float32Array(count);
    faces.group = new Uint32Array(count);
}

function sizeRaster(width, height) {
    if (raster.width === width && raster.height === height)
        return;
    const count = width * height * SLOTS;
    Object.assign(raster, { width, height, near: new Float32Array(count), id: new Int32Array(count) });
}

function clearRaster() {
    raster.near.fill(-Infinity);
    raster.id.fill(NO_FACE);
}

function fillPixel(pixel, id, group, z) {
    const { near, id: ids } = raster, first = pixel * SLOTS, last = first + SLOTS - 1;
    if (z <= near[last])
        return;
    let at = first;
    while (at < last && ids[at] !== NO_FACE && faces.group[ids[at]] !== group)
        at++;
    if (z <= near[at])
        return;
    for (; at > first && near[at - 1] + SAME_DEPTH < z; at--) {
        near[at] = near[at - 1];
        ids[at] = ids[at - 1];
    }
    near[at] = z;
    ids[at] = id;
}

/* Draws a face that covers no pixel centre as a dot, so that many small faces remain visible. */
function fillDot(id, group, x, y, z) {
    const column = Math.floor(x), row = Math.floor(y);
    if (column >= 0 && row >= 0 && column < raster.width && row < raster.height)
        fillPixel(row * raster.width + column, id, group, z);
}

/* The edges of a face that are not horizontal. In the row at y the face lies to the left of those
 * that go down and to the right of those that go up; an edge is at x + slope * (y - its y). */
const edges = {
    count: 0, x: new Float64Array(3), y: new Float64Array(3), slope: new Float64Array(3),
    down: new Uint8Array(3),
};

/* Adds the edge from p to q of a face whose corners are clockwise on the screen. */
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

/* The change of depth from pixel to pixel, horizontally and vertically. (ux, uy): first corner to
 * second; (vx, vy): first to third; area: twice that of the face. */
function slopes(p, ux, uy, vx, vy, area) {
    const uz = p[5] - p[2], vz = p[8] - p[2];
    return [(uz * vy - vz * uy) / area, (vz * ux - uz * vx) / area];
}

/* Fills the pixels whose centres the face covers. Returns whether there are any. */
function fillRows(id, group, p, [across, down]) {
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
            fillPixel(at, id, group, z);
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

/* p: x and y in pixels and z towards the viewer, for each of 3 corners. */
function fillFace(id, group, p) {
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
        drawn = fillRows(id, group, p, slopes(p, ux, uy, vx, vy, area));
    }
    if (!drawn)
        fillDot(id, group, (p[0] + p[3] + p[6]) / 3, (p[1] + p[4] + p[7]) / 3,
            (p[2] + p[5] + p[8]) / 3);
}

/* Projects the vertices to pixels of the raster. rows: a 3 x 4 matrix. */
function projectSolid(solid, rows) {
    const { corner } = solid, count = corner.length;
    solid.seen ??= new Float64Array(count);
    for (let i = 0; i < count; i += 3)
        for (let k = 0; k < 3; k++)
            solid.seen[i + k] = rows[4 * k] * corner[i] + rows[4 * k + 1] * corner[i + 1]
                + rows[4 * k + 2] * corner[i + 2] + rows[4 * k + 3];
}

/* The matrix of project(), which is affine. */
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

/* Draws a solid. corner: x, y, z of each vertex; face: vertices of each triangle; id: of the face
 * that each triangle belongs to; shift: displacement during the window. */
function rasterise(solid, project, scale, moment) {
    projectSolid(solid, rowsOf(project, scale, solid.shift.map((value) => value * moment)));
    const { face, seen, id } = solid;
    for (let f = 0; f < id.length; f++) {
        for (let k = 0; k < 3; k++) {
            const from = 3 * face[3 * f + k];
            corners[3 * k] = seen[from];
            corners[3 * k + 1] = seen[from + 1];
            corners[3 * k + 2] = seen[from + 2];
        }
        fillFace(id[f], faces.group[id[f]], corners);
    }
}

function shadeFace(id, [lit, dark], light) {
    for (let i = 0; i < 3; i++)
        faces.shade[3 * id + i] = light * lit[i] + (1 - light) * dark[i];
}

function isOpaque(id) {
    return faces.cover[id] === 1;
}

/* The id of the face at a pixel: the first opaque one, otherwise the nearest. */
function faceAt(column, row) {
    if (!(column >= 0 && row >= 0 && column < raster.width && row < raster.height))
        return NO_FACE;
    const first = (row * raster.width + column) * SLOTS;
    const ids = raster.id.subarray(first, first + SLOTS);
    return ids.find(isOpaque) ?? ids[0];
}

/* ---- Colours of pixels ---- */

const COVER_VEIL = 0.26; /* opacity of a face in front of an opaque one */

function holds(pixel, face) {
    for (let at = pixel * SLOTS; at < (pixel + 1) * SLOTS; at++)
        if (raster.id[at] === face)
            return true;
    return false;
}

function holdsOpaque(pixel) {
    for (let at = pixel * SLOTS; at < (pixel + 1) * SLOTS; at++)
        if (isOpaque(raster.id[at]))
            return true;
    return false;
}

/* edges: darkness of edges, 0 to 1 */
function paintPixel(pixels, pixel, edges) {
    const { id, width } = raster, first = pixel * SLOTS, to = 4 * pixel;
    const hasOpaque = holdsOpaque(pixel);
    let red = 0, green = 0, blue = 0, left = 1;
    for (let k = 0; k < SLOTS && id[first + k] !== NO_FACE && left > 0; k++) {
        const face = id[first + k], { shade, cover } = faces;
        const seen = left * (hasOpaque && cover[face] < 1 ? COVER_VEIL : cover[face]);
        const isEdge = edges > 0 && !(holds(pixel - 1, face) && holds(pixel - width, face));
        const share = isEdge ? seen * (1 - edges) : seen;
        red += share * shade[3 * face];
        green += share * shade[3 * face + 1];
        blue += share * shade[3 * face + 2];
        left -= seen;
    }
    pixels[to] = red / (1 - left);
    pixels[to + 1] = green / (1 - left);
    pixels[to + 2] = blue / (1 - left);
    pixels[to + 3] = 255 * (1 - left);
}

/* pixels: red, green, blue and opacity, a byte each */
function paintPixels(pixels, edges) {
    for (let pixel = 0; pixel < raster.width * raster.height; pixel++) {
        if (raster.id[pixel * SLOTS] === NO_FACE)
            pixels[4 * pixel + 3] = 0;
        else
            paintPixel(pixels, pixel, edges);
    }
}
