/* Colours of faces, and of pixels: what does not meet is half faint, so that what meets is seen
 * through it. */

/* Lit and dark. */
const OF_MESH = [[[216, 218, 222], [104, 108, 114]], [[158, 198, 246], [36, 78, 140]]];
const OF_TOUCHING = [[255, 214, 74], [196, 140, 0]];
const OF_OVERLAPPING = [[244, 70, 60], [190, 14, 18]];
const OF_LATER = [[236, 176, 168], [150, 96, 92]]; /* meets, but not at this moment */

/* How much of it covers what is behind: of 1; less where that is a face that meets. */
const COVER = 0.64, COVER_MET = 0.26;
const EDGE = 0.3; /* how dark edges are */

/* Red, green and blue of each face, one byte each. */
const shades = new Uint8Array(3 * faceCount);
const lights = new Float32Array(faceCount);

function lightFaces() {
    for (let id = 0; id < faceCount; id++)
        lights[id] = lightOf(...cornersOf(id, 0).map(upright));
}

/* By verdict: 1 where the face is in contact at this moment. A face whose pairs are not listed
 * has no times here: it is taken to be. */
function contactNow(moment) {
    const now = new Uint8Array(faceCount).fill(1), time = moment * data.T;
    if (!isMoving)
        return now;
    for (const id of pairsOfFace.keys())
        now[id] = 0;
    for (const { a, b, times } of pairs)
        if (times[0] <= time && time <= times[1])
            now[a] = now[b] = 1;
    return now;
}

function coloursOf(mesh, colour, isNow) {
    if (colour < TOUCHING)
        return OF_MESH[mesh.index];
    if (!isNow)
        return OF_LATER;
    return colour === TOUCHING ? OF_TOUCHING : OF_OVERLAPPING;
}

function shadeFaces(moment) {
    const now = contactNow(moment);
    for (const mesh of meshes) {
        mesh.colour.forEach((colour, f) => {
            const id = mesh.first + f, light = lights[id];
            const [lit, dark] = coloursOf(mesh, colour, now[id]);
            for (let i = 0; i < 3; i++)
                shades[3 * id + i] = light * lit[i] + (1 - light) * dark[i];
        });
    }
}

/* ---- Pixels ---- */

/* What of the light of a face at this pixel is left: less where its neighbour is another one. */
function shareOf(ids, at, edges) {
    const isEdge = edges > 0 && (ids[at] !== ids[at - 1] || ids[at] !== ids[at - raster.width]);
    return isEdge ? 1 - EDGE * edges : 1;
}

/* Layers from near to far at a pixel. */
const order = new Uint8Array(LAYERS);

function sortLayers(at) {
    const [first, second, third] = raster.near;
    const a = first[at], b = second[at], c = third[at];
    const before = b > a ? 1 : 0, after = 1 - before;
    const near = b > a ? b : a, far = b > a ? a : b;
    order[0] = c > near ? MET_LAYER : before;
    order[1] = c > near ? before : c > far ? MET_LAYER : after;
    order[2] = c > far ? after : MET_LAYER;
}

/* Several layers, one behind the other. */
function mixPixel(pixels, at, edges) {
    const { id } = raster, to = 4 * at;
    const cover = id[MET_LAYER][at] === NO_FACE ? COVER : COVER_MET;
    let red = 0, green = 0, blue = 0, left = 1;
    sortLayers(at);
    for (let k = 0; k < LAYERS && left > 0; k++) {
        const ids = id[order[k]], face = ids[at];
        if (face === NO_FACE)
            break;
        const seen = left * (order[k] === MET_LAYER ? 1 : cover);
        const share = seen * shareOf(ids, at, edges);
        red += share * shades[3 * face];
        green += share * shades[3 * face + 1];
        blue += share * shades[3 * face + 2];
        left -= seen;
    }
    pixels[to] = red / (1 - left);
    pixels[to + 1] = green / (1 - left);
    pixels[to + 2] = blue / (1 - left);
    pixels[to + 3] = 255 * (1 - left);
}

function paintPixel(pixels, at, ids, cover, edges) {
    const to = 4 * at, from = 3 * ids[at], share = shareOf(ids, at, edges);
    pixels[to] = share * shades[from];
    pixels[to + 1] = share * shades[from + 1];
    pixels[to + 2] = share * shades[from + 2];
    pixels[to + 3] = 255 * cover;
}

/* pixels: red, green, blue and how much they cover, a byte each. edges: how much of them is seen,
 * 0 to 1. Few pixels have more than one layer. */
function paintPixels(pixels, edges) {
    const [first, second, met] = raster.id;
    for (let at = 0; at < met.length; at++) {
        const of = (first[at] === NO_FACE ? 0 : 1) + (second[at] === NO_FACE ? 0 : 2)
            + (met[at] === NO_FACE ? 0 : 4);
        if (of === 0)
            pixels[4 * at + 3] = 0;
        else if (of === 1)
            paintPixel(pixels, at, first, COVER, edges);
        else if (of === 2)
            paintPixel(pixels, at, second, COVER, edges);
        else
            mixPixel(pixels, at, edges);
    }
}
