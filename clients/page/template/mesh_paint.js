/* Colours of faces, and of pixels: what does not meet is half faint, so that what meets is seen
 * through it. */

/* Lit and dark. */
const OF_MESH = [[[232, 233, 235], [112, 116, 122]], [[158, 198, 246], [36, 78, 140]]];
const OF_TOUCHING = [[255, 214, 74], [196, 140, 0]];
const OF_OVERLAPPING = [[240, 62, 54], [150, 8, 12]];
const OF_LATER = [[236, 176, 168], [150, 96, 92]]; /* meets, but not at this moment */

/* How much of it covers what is behind: of 1; less where that is a face that meets. */
const COVER = 0.58, COVER_MET = 0.3;
const EDGE = 0.3; /* how dark edges are */

/* Red, green and blue of each face, one byte each. */
const shades = new Uint8Array(3 * faceCount);
const lights = new Float32Array(faceCount);

function lightFaces() {
    for (let id = 0; id < faceCount; id++)
        lights[id] = lightOf(...cornersOf(id, 0));
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

function isEdge(ids, at, width) {
    return ids[at] !== ids[at - 1] || ids[at] !== ids[at - width];
}

/* Layers from near to far at a pixel: [0, 1, 2] in the order of their nearness. */
const order = [0, 1, 2];

function sortLayers(at) {
    const { near } = raster;
    let p = 0, q = 1, r = MET_LAYER;
    if (near[q][at] > near[p][at])
        [p, q] = [q, p];
    if (near[r][at] > near[q][at]) {
        [q, r] = [r, q];
        if (near[q][at] > near[p][at])
            [p, q] = [q, p];
    }
    order[0] = p;
    order[1] = q;
    order[2] = r;
}

/* pixels: red, green, blue and how much they cover, a byte each. edges: how much of them is seen,
 * 0 to 1. */
function paintPixels(pixels, edges) {
    const { width, id } = raster, met = id[MET_LAYER];
    for (let at = 0; at < met.length; at++) {
        const to = 4 * at;
        if (id[0][at] === NO_FACE && id[1][at] === NO_FACE && met[at] === NO_FACE) {
            pixels[to + 3] = 0;
            continue;
        }
        sortLayers(at);
        const cover = met[at] === NO_FACE ? COVER : COVER_MET;
        let red = 0, green = 0, blue = 0, left = 1;
        for (let k = 0; k < LAYERS && left > 0; k++) {
            const layer = order[k], face = id[layer][at];
            if (face === NO_FACE)
                break;
            const edge = edges > 0 && isEdge(id[layer], at, width) ? 1 - EDGE * edges : 1;
            const part = left * (layer === MET_LAYER ? 1 : cover);
            red += part * edge * shades[3 * face];
            green += part * edge * shades[3 * face + 1];
            blue += part * edge * shades[3 * face + 2];
            left -= part;
        }
        pixels[to] = red / (1 - left);
        pixels[to + 1] = green / (1 - left);
        pixels[to + 2] = blue / (1 - left);
        pixels[to + 3] = 255 * (1 - left);
    }
}
