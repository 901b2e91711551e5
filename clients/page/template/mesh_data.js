/* The data of the page, and values derived once: meshes, and pairs of their faces. */

const data = JSON.parse(document.getElementById("data").textContent);

/* Decodes little-endian numbers of 4 bytes, the byte order of all browsers. */
function unpack(text, Kind) {
    const read = atob(text), bytes = new Uint8Array(read.length);
    for (let i = 0; i < read.length; i++)
        bytes[i] = read.charCodeAt(i);
    return new Kind(bytes.buffer);
}

/* Returns corner: [x, y, z] of each vertex; face: three vertices of each face; colour: the worst
 * verdict of each face, or 0; first: the id of its first face. Ids number the faces of all meshes.
 */
function readMesh(mesh, index) {
    return {
        index, name: mesh.name, faces: mesh.faces, met: mesh.met, shift: mesh.shift,
        corner: unpack(mesh.corner, Float32Array), face: unpack(mesh.face, Uint32Array),
        colour: unpack(mesh.colour, Uint8Array),
        first: 0,
    };
}

const meshes = data.meshes.map(readMesh);
if (meshes.length > 1)
    meshes[1].first = meshes[0].faces;
for (const mesh of meshes)
    mesh.id = Uint32Array.from(mesh.colour, (_, f) => mesh.first + f);
const faceCount = meshes.reduce((sum, mesh) => sum + mesh.faces, 0);
const isSelf = meshes.length === 1;
const isMoving = data.moving && data.T > 0;

function meshLetter(index) {
    return index === 0 || isSelf ? "A" : "B";
}

function baseName(path) {
    return path.replace(/.*[/\\](?=.)/, "");
}

/* ---- Faces ---- */

function meshOfFace(id) {
    return meshes[meshes.length > 1 && id >= meshes[1].first ? 1 : 0];
}

/* The number of a face in its file. */
function numberOfFace(id) {
    return id - meshOfFace(id).first;
}

/* [[x, y, z], ...], the corners of a face at a moment of the window, 0 to 1. */
function cornersOf(id, moment) {
    const mesh = meshOfFace(id), { corner, face, shift } = mesh, at = 3 * (id - mesh.first);
    return [0, 1, 2].map((k) => [0, 1, 2].map((axis) => corner[3 * face[at + k] + axis]
        + moment * shift[axis]));
}

/* ---- Pairs ---- */

/* a, b: ids of faces; numbers: those of the files; times: [first, last] or null, seconds */
const pairs = data.pairs.map(([a, b, verdict, ...times], index) => ({
    index, numbers: [a, b], verdict, times: times.length ? times : null,
    a, b: meshes[meshes.length - 1].first + b,
}));

/* The listed pairs of each face that is in any. */
const pairsOfFace = new Map();
for (const pair of pairs) {
    for (const id of [pair.a, pair.b]) {
        if (!pairsOfFace.has(id))
            pairsOfFace.set(id, []);
        pairsOfFace.get(id).push(pair);
    }
}
