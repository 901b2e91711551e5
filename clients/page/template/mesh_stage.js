/* The picture of the meshes at a moment of the window: where they are, and the chosen pair of faces on
 * top of them. */

const NEAR_PAIR = 0.35;       /* the part of the canvas that a pair fills, of what all fills */
const BOUND_POINTS = 3000;    /* vertices of a mesh that tell where it is */

function chosenPair() {
    return chosen.pair;
}

/* ---- Bounds ---- */

function pointsOf(mesh, moment) {
    const { corner, shift } = mesh, points = [];
    const step = 3 * Math.max(1, Math.floor(corner.length / 3 / BOUND_POINTS));
    for (let at = 0; at < corner.length; at += step)
        points.push([0, 1, 2].map((axis) => corner[at + axis] + moment * shift[axis]));
    return points;
}

function boundsNow() {
    const points = meshes.flatMap((mesh) => pointsOf(mesh, stage.moment));
    return boundsOfPoints(points.length ? points : [[0, 0, 0]]);
}

function fitAll() {
    stage.camera.bounds = boundsNow();
    fit(stage.camera.bounds);
    redrawStage();
}

/* The two faces in the middle, with what is around them. How far one may zoom is still told by
 * the whole. */
function fitPair() {
    const pair = chosenPair(), { camera } = stage, { fitted } = camera;
    if (!pair)
        return;
    fit(boundsOfPoints([pair.a, pair.b].flatMap((id) => cornersOf(id, stage.moment))));
    camera.zoom *= NEAR_PAIR;
    camera.pan = camera.pan.map((pan) => pan * NEAR_PAIR);
    camera.fitted = fitted;
    redrawStage();
}

/* The axis that is up: y is where meshes are made for pictures, z where they are for machines. */
function setUp(axis) {
    stage.up = axis;
    for (const [id, of] of [["up-y", 1], ["up-z", 2]])
        find(id).setAttribute("aria-pressed", String(of === axis));
    lightFaces();
    fit(stage.camera.bounds);
    redrawStage();
}

/* ---- Drawing ---- */

function meanEdge() {
    let sum = 0, count = 0;
    const step = Math.max(1, Math.floor(faceCount / BOUND_POINTS));
    for (let id = 0; id < faceCount; id += step, count++) {
        const [a, b] = cornersOf(id, 0);
        sum += Math.hypot(...minus(a, b));
    }
    return count ? sum / count : 0;
}

/* Edges are drawn where there is room between them: in pixels. */
const EDGES_FROM = 7, EDGES_FULL = 24, EDGE_DARK = 0.3;

function edgeDarkness() {
    const size = stage.edge * stage.camera.zoom;
    return EDGE_DARK * clamp((size - EDGES_FROM) / (EDGES_FULL - EDGES_FROM), 0, 1);
}

function drawScene(context, project) {
    drawGround(context, project);
    drawFaces(context, project, edgeDarkness());
    drawPair(context, project);
}

/* ---- The chosen pair ---- */

function strokeHalo(context, colour, width) {
    context.strokeStyle = stage.theme.card;
    context.lineWidth = width + 2.5;
    context.stroke();
    context.strokeStyle = colour;
    context.lineWidth = width;
    context.stroke();
}

/* One face's name stands above it, the other's below. */
function drawPair(context, project) {
    const pair = chosenPair();
    if (!pair)
        return;
    [pair.a, pair.b].forEach((id, which) => {
        const points = cornersOf(id, stage.moment).map(project);
        const ys = points.map((p) => p[1]), x = points.reduce((sum, p) => sum + p[0], 0) / 3;
        const colour = which ? stage.theme.link : stage.theme.ink;
        if (!tracePolygon(context, points))
            return;
        context.setLineDash(which ? [6, 3] : []);
        strokeHalo(context, colour, 2);
        context.setLineDash([]);
        context.strokeStyle = colour;
        drawRing(context, points);
        const text = `${meshLetter(which)} ${pair.numbers[which]}`;
        drawLabel(context, text, x, which ? Math.max(...ys) + 18 : Math.min(...ys) - 9, colour);
    });
}

/* ---- What is pointed at ---- */

function point(at) {
    const id = at ? faceBelow(at) : NO_FACE;
    if (id === NO_FACE) {
        showTip(null);
        return;
    }
    const mesh = meshOfFace(id), colour = mesh.colour[id - mesh.first];
    const count = pairsOfFace.get(id)?.length ?? 0;
    showTip(at, `${meshLetter(mesh.index)} ${numberOfFace(id)}`
        + (colour ? `: ${verdictName(colour)}, ${counted(count, "pair", "pairs")}` : ""));
}

/* A click on a face that meets chooses its pairs one after the other. */
function chooseBelow(at) {
    const list = pairsOfFace.get(faceBelow(at)) ?? [];
    if (list.length > 0)
        choosePair(list[(list.indexOf(chosen.pair) + 1) % list.length], false);
}
