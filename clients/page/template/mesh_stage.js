/* The picture of the meshes at a moment of the window, with the chosen pair of faces on top. */

const NEAR_PAIR = 0.35;       /* part of the canvas that a pair fills */
const BOUND_POINTS = 3000;    /* vertices of a mesh that are used for its bounds */

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

/* Centres the chosen pair, with its surroundings. The zoom limits remain those of the whole. */
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

/* Sets the vertical axis: y is usual in graphics, z in engineering. */
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

/* Edges fade in with the mean length of an edge in pixels, from EDGES_FROM to EDGES_FULL. */
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

/* Labels one face above it, the other below. */
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

/* ---- Pointer ---- */

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

/* Chooses the pairs of the face at the pointer in turn. */
function chooseBelow(at) {
    const list = pairsOfFace.get(faceBelow(at)) ?? [];
    if (list.length > 0)
        choosePair(list[(list.indexOf(chosen.pair) + 1) % list.length], false);
}
