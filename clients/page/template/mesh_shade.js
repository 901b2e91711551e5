/* Colours of mesh faces. Faces that do not intersect are half transparent, so that those that do
 * are visible through them. */

/* Lit and dark. */
const OF_MESH = [[[216, 218, 222], [104, 108, 114]], [[158, 198, 246], [36, 78, 140]]];
const OF_TOUCHING = [[255, 214, 74], [196, 140, 0]];
const OF_OVERLAPPING = [[244, 70, 60], [190, 14, 18]];
const OF_LATER = [[236, 176, 168], [150, 96, 92]]; /* intersects, but not at this moment */

const COVER = 0.64;
const GROUP_MET = 2; /* group of faces that intersect; other faces have the group of their mesh */

const lights = new Float32Array(faceCount);
let shadedMoment = null;

function groupFaces() {
    allotFaces(faceCount);
    for (const mesh of meshes) {
        mesh.colour.forEach((colour, f) => {
            faces.cover[mesh.first + f] = colour ? 1 : COVER;
            faces.group[mesh.first + f] = colour ? GROUP_MET : mesh.index;
        });
    }
}

function lightFaces() {
    for (let id = 0; id < faceCount; id++)
        lights[id] = lightOf(...cornersOf(id, 0).map(rotateUp));
    shadedMoment = null;
}

/* For each face 1 if it is in contact at this moment. A face whose pairs are not listed has no
 * times here, and is assumed to be in contact. */
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

function shadeFaces() {
    if (shadedMoment === stage.moment)
        return;
    shadedMoment = stage.moment;
    const now = contactNow(stage.moment);
    for (const mesh of meshes) {
        mesh.colour.forEach((colour, f) => {
            const id = mesh.first + f;
            shadeFace(id, coloursOf(mesh, colour, now[id]), lights[id]);
        });
    }
}
