/* The picture: faces in pixels, with lines and text on top. While it changes, pixels are coarse if
 * fine ones take long. Each page defines stage.solids (raster.js), shadeFaces(), which sets the
 * colours of faces, and drawScene(), which draws all. */

const FINE = 2;               /* raster pixels for each page pixel at rest */
const PIXELS_MAX = 6e6;
const REST_AFTER = 150;       /* milliseconds */
const SLOW = 90;              /* milliseconds: a slower picture makes the next one coarser */
const COARSEST = 0.35;

const picture = {
    canvas: document.createElement("canvas"), image: null, /* pixels of the raster */
    scale: 1, coarse: 1,    /* raster pixels for each page pixel: now, and while it changes */
    resting: 0,             /* the timer */
};

function sizePicture(wanted) {
    picture.scale = Math.min(wanted, Math.sqrt(PIXELS_MAX / (stage.width * stage.height)));
    const width = Math.max(1, Math.round(stage.width * picture.scale));
    const height = Math.max(1, Math.round(stage.height * picture.scale));
    sizeRaster(width, height);
    if (picture.image?.width === width && picture.image.height === height)
        return;
    picture.canvas.width = width;
    picture.canvas.height = height;
    picture.image = picture.canvas.getContext("2d").createImageData(width, height);
}

/* edges: darkness of edges between faces, 0 to 1 */
function drawFaces(context, project, edges) {
    clearRaster();
    shadeFaces();
    for (const solid of stage.solids)
        rasterise(solid, project, picture.scale, stage.moment);
    paintPixels(picture.image.data, edges * Math.min(1, picture.scale / FINE));
    picture.canvas.getContext("2d").putImageData(picture.image, 0, 0);
    context.imageSmoothingQuality = "high";
    context.drawImage(picture.canvas, 0, 0, stage.width, stage.height);
}

function drawStage(wanted) {
    const context = clearStage(), begin = performance.now();
    sizePicture(wanted);
    context.lineJoin = "round";
    if (stage.camera)
        drawScene(context, projection());
    return performance.now() - begin;
}

/* Draws a picture that changes: coarser if the last one was slow, finer if it was fast. */
function drawMoving() {
    const taken = drawStage(picture.coarse);
    const times = taken > SLOW ? 0.75 : taken < SLOW / 3 ? 1.25 : 1;
    picture.coarse = clamp(picture.coarse * times, COARSEST, FINE);
}

const drawFine = onceAFrame(() => drawStage(Math.max(FINE, devicePixelRatio)));

const redrawStage = onceAFrame(() => {
    drawMoving();
    clearTimeout(picture.resting);
    picture.resting = setTimeout(drawFine, REST_AFTER);
});

function faceBelow({ x, y }) {
    return faceAt(Math.floor(x * picture.scale), Math.floor(y * picture.scale));
}
