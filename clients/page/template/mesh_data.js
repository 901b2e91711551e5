/* The data of the page, and what is made of them once: meshes, and pairs of their faces. */

const data = JSON.parse(document.getElementById("data").textContent);

/* Four bytes of a number have the lowest first, as browsers have them. */
function unpack(text, Kind) {
    const read = atob(text), bytes = new Uint8Array(read.length);
    for (let i = 0; i < read.length; i++)
        bytes[i] = read.charCodeAt(i);
    return new Kind(bytes.buffer);
}

/* corner: [x, y, z] of each vertex; face: three vertices of each; colour: its worst verdict, or 0;
 * number: of each in the file, or null where all are here; first: the number of its first face
 * among those of all meshes, by which pictures know them. */
function readMesh(mesh, index) {
    return {
        index, name: mesh.name, faces: mesh.faces, met: mesh.met, shift: mesh.shift,
        corner: unpack(mesh.corner, Float32Array), face: unpack(mesh.face, Uint32Array),
        colour: unpack(mesh.colour, Uint8Array),
        number: mesh.number === null ? null : unpack(mesh.number, Uint32Array), first: 0,
    };
}

function shownFaces(mesh) {
    return mesh.colour.length;
}

const meshes = data.meshes.map(readMesh);
if (meshes.length > 1)
    meshes[1].first = shownFaces(meshes[0]);
const faceCount = meshes.reduce((sum, mesh) => sum + shownFaces(mesh), 0);
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

/* As the file counts it. */
function numberOfFace(id) {
    const mesh = meshOfFace(id);
    return mesh.number ? mesh.number[id - mesh.first] : id - mesh.first;
}

/* Where the face of this number is among all; it is there where it is in a pair. */
function faceOfNumber(mesh, number) {
    return mesh.first + (mesh.number ? lowerBound(mesh.number, number) : number);
}

/* [[x, y, z], ...] at a moment of the window. */
function cornersOf(id, moment) {
    const mesh = meshOfFace(id), { corner, face, shift } = mesh, at = 3 * (id - mesh.first);
    return [0, 1, 2].map((k) => [0, 1, 2].map((axis) => corner[3 * face[at + k] + axis]
        + moment * shift[axis]));
}

/* ---- Pairs ---- */

/* a, b: faces of the picture; numbers: of the files; times: [first, last] or null, seconds. */
const pairs = data.pairs.map(([a, b, verdict, ...times], index) => ({
    index, numbers: [a, b], verdict, times: times.length ? times : null,
    a: faceOfNumber(meshes[0], a), b: faceOfNumber(meshes[meshes.length - 1], b),
}));

/* Of each face that is in listed pairs, these. */
const pairsOfFace = new Map();
for (const pair of pairs) {
    for (const id of [pair.a, pair.b]) {
        if (!pairsOfFace.has(id))
            pairsOfFace.set(id, []);
        pairsOfFace.get(id).push(pair);
    }
}
