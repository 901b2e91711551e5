/* The picture on the stage: faces in pixels, lines and text over them. The pixels are coarse where
 * fine ones would take long, and fine once nothing moves. The page's own are stage.solids (raster.js),
 * shadeFaces(), which colours their faces, and drawScene(), which draws all. */

const FINE = 2;               /* pixels of the raster for one of the page */
const PIXELS_MAX = 6e6;
const REST_AFTER = 150;       /* milliseconds */
const SLOW = 90;              /* milliseconds that a picture may take */
const COARSEST = 0.35;

const picture = {
    canvas: document.createElement("canvas"), image: null, /* the raster's pixels */
    scale: 1, coarse: 1,    /* pixels for one of the page: now, and while it moves */
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

/* edges: how dark they are between faces, 0 to 1. */
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

/* Coarser where pictures take long, and less coarse again where they do not. */
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
