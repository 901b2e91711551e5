/* The state of the stage (the picture) and its camera. */

const FIT = 0.88; /* part of the canvas that the bounds fill */

const stage = {
    width: 600, height: 400,
    azimuth: OBLIQUE.azimuth, elevation: OBLIQUE.elevation,
    up: 2,                  /* the vertical axis in 3D: 2 is z, 1 is y */
    event: null, frames: [], units: null, bounds: null, pairs: [],
    moment: 0,              /* position in the window, 0 to 1 */
    camera: null,           /* {target, zoom, pan}; shared by events with the same bodies */
    solids: [], pointed: -1, /* what the raster draws (raster.js) */
    theme: {},
};

/* ---- The camera ---- */

/* Rotates about x so that the vertical axis becomes z. */
function rotateUp([x, y, z]) {
    return stage.up === 2 ? [x, y, z] : [x, -z, y];
}

function rotation() {
    const rotate = turn(stage.units.dim, stage.azimuth, stage.elevation);
    return (p) => rotate(rotateUp(p));
}

/* The view along an axis of the world, or the oblique one. */
function viewOf(name) {
    const others = { y: "z", z: "y" };
    return VIEWS[stage.up === 2 ? name : others[name] ?? name];
}

function projection() {
    const rotate = rotation();
    const { target, zoom, pan } = stage.camera;
    return (p) => {
        const [right, up, depth] = rotate(minus(p, target));
        return [stage.width / 2 + pan[0] + zoom * right, stage.height / 2 + pan[1] - zoom * up,
            depth];
    };
}

/* Margins for the axis labels in 2D, pixels. */
function plotMargins() {
    return stage.units.dim === 2 ? { left: 56, bottom: 24 } : { left: 0, bottom: 0 };
}

/* Moves the camera so that the bounds fill the stage. Keeps its direction. */
function fit(bounds) {
    const { camera } = stage, rotate = rotation();
    camera.target = bounds.low.map((low, axis) => (low + bounds.high[axis]) / 2);
    const points = bounds.points.map((point) => rotate(minus(point, camera.target)));
    const ends = [0, 1].map((axis) => points.map((point) => point[axis]))
        .map((values) => [Math.min(...values), Math.max(...values)]);
    const { left, bottom } = plotMargins(), space = [stage.width - left, stage.height - bottom];
    const wanted = ends.map(([low, high], axis) => space[axis] / Math.max(high - low, 1e-300));
    /* A single point gets a fixed zoom. */
    camera.zoom = extent(bounds) > 0 ? Math.min(FIT * wanted[0], FIT * wanted[1], 1e13) : 200;
    camera.fitted = camera.zoom;
    const [right, up] = ends.map(([low, high]) => (low + high) / 2 * camera.zoom);
    camera.pan = [left / 2 - right, up - bottom / 2];
}

function zoomStage(factor, x, y) {
    const { camera } = stage;
    const zoom = clamp(camera.zoom * factor, camera.fitted / 50, camera.fitted * 1e9);
    const by = zoom / camera.zoom, from = [x - stage.width / 2, y - stage.height / 2];
    camera.pan = camera.pan.map((pan, axis) => from[axis] + (pan - from[axis]) * by);
    camera.zoom = zoom;
    redrawStage();
}
