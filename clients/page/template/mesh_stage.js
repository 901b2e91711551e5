/* The picture: the meshes at a moment of the window, the chosen pair of faces on top of them, and
 * what of it the camera sees. While it moves it is coarse; when it rests, it is drawn again, with
 * finer pixels. */

const FINE = 2;               /* pixels of the raster for one of the page */
const FINE_PIXELS = 6e6;      /* no more of them */
const REST_AFTER = 150;       /* milliseconds */
const SLOW = 90;              /* milliseconds that a picture may take */
const COARSEST = 0.35;
const NEAR_PAIR = 0.35;       /* the part of the canvas that a pair fills, of what all fills */
const BOUND_POINTS = 3000;    /* vertices of a mesh that tell where it is */

const picture = {
    canvas: document.createElement("canvas"), image: null, /* the raster's pixels */
    scale: 1, coarse: 1,    /* pixels for one of the page: now, and while it moves */
    shaded: null,           /* the moment that the colours of faces are of */
    edge: 0,                /* how long edges are */
    resting: 0,             /* the timer */
};

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
    picture.shaded = null;
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
const EDGES_FROM = 7, EDGES_FULL = 24;

function edgeStrength() {
    const size = picture.edge * stage.camera.zoom;
    return clamp((size - EDGES_FROM) / (EDGES_FULL - EDGES_FROM), 0, 1);
}

function sizePicture(wanted) {
    const most = Math.sqrt(FINE_PIXELS / (stage.width * stage.height));
    picture.scale = Math.min(wanted, most);
    const width = Math.max(1, Math.round(stage.width * picture.scale));
    const height = Math.max(1, Math.round(stage.height * picture.scale));
    sizeRaster(width, height);
    if (picture.image?.width === width && picture.image.height === height)
        return;
    picture.canvas.width = width;
    picture.canvas.height = height;
    picture.image = picture.canvas.getContext("2d").createImageData(width, height);
}

function drawMeshes(context, project, wanted) {
    sizePicture(wanted);
    clearRaster();
    for (const mesh of meshes)
        rasterise(mesh, project, picture.scale, stage.moment);
    if (picture.shaded !== stage.moment)
        shadeFaces(stage.moment);
    picture.shaded = stage.moment;
    paintPixels(picture.image.data, edgeStrength() * Math.min(1, picture.scale / FINE));
    picture.canvas.getContext("2d").putImageData(picture.image, 0, 0);
    context.imageSmoothingQuality = "high";
    context.drawImage(picture.canvas, 0, 0, stage.width, stage.height);
}

function drawStage(wanted) {
    const context = clearStage(), project = projection(), begin = performance.now();
    drawGrid3D(context, project);
    drawMeshes(context, project, wanted);
    drawTriad(context);
    context.lineJoin = "round";
    drawPair(context, project);
    return performance.now() - begin;
}

/* Coarser where pictures take long, and less coarse again where they do not. */
function drawMoving() {
    const taken = drawStage(picture.coarse);
    const times = taken > SLOW ? 0.75 : taken < SLOW / 3 ? 1.25 : 1;
    picture.coarse = clamp(picture.coarse * times, COARSEST, 1);
}

const drawFine = onceAFrame(() => drawStage(Math.max(FINE, devicePixelRatio)));

const redrawStage = onceAFrame(() => {
    drawMoving();
    clearTimeout(picture.resting);
    picture.resting = setTimeout(drawFine, REST_AFTER);
});

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

function faceBelow({ x, y }) {
    return faceAt(Math.floor(x * picture.scale), Math.floor(y * picture.scale));
}

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
