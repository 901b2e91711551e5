/* Drawing functions for the canvas; the grid and the axes. */

function measureStage() {
    const canvas = find("stage");
    stage.width = canvas.clientWidth || 600;
    stage.height = canvas.clientHeight || 400;
}

/* Sets the canvas to its size on the screen, in device pixels, and clears it. */
function clearStage() {
    const canvas = find("stage"), ratio = window.devicePixelRatio || 1;
    measureStage();
    const wanted = [Math.round(stage.width * ratio), Math.round(stage.height * ratio)];
    if (canvas.width !== wanted[0] || canvas.height !== wanted[1])
        [canvas.width, canvas.height] = wanted;
    const context = canvas.getContext("2d");
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    context.clearRect(0, 0, stage.width, stage.height);
    return context;
}

/* ---- Colours ---- */

/* Lit and dark colour for each verdict; frames without a pair are grey. */
const COLOURS = {
    [-1]: [[214, 219, 226], [122, 130, 141]], 0: [[214, 219, 226], [122, 130, 141]],
    1: [[173, 203, 236], [58, 106, 160]], 2: [[255, 216, 130], [184, 124, 12]],
    3: [[255, 168, 158], [190, 48, 44]],
};

function readTheme() {
    const style = getComputedStyle(document.documentElement);
    for (const name of ["card", "ink", "dim", "grid", "box", "diff", "rule", "link"])
        stage.theme[name] = style.getPropertyValue(`--${name}`).trim();
    stage.theme.dark = matchMedia("(prefers-color-scheme: dark)").matches;
}

function strokeOf(verdict, alpha) {
    const [lit, dark] = COLOURS[verdict], light = stage.theme.dark ? 0.65 : 0;
    const mixed = lit.map((value, i) => Math.round(light * value + (1 - light) * dark[i]));
    return `rgba(${mixed.join(",")},${alpha})`;
}

/* ---- Lines and text ---- */

/* Adds the visible part of the polygon to the path. Returns false if there is none. */
function addToPath(context, points) {
    const kept = clipPolygon(points, stage.width, stage.height);
    kept.forEach(([x, y], i) => i ? context.lineTo(x, y) : context.moveTo(x, y));
    return kept.length > 0;
}

function tracePolygon(context, points) {
    context.beginPath();
    const isSeen = addToPath(context, points);
    context.closePath();
    return isSeen;
}

function drawLine(context, a, b) {
    tracePolygon(context, [a, b]);
    context.stroke();
}

/* Draws each edge once, although two faces share it: overlaid dashes would look solid. */
function drawEdges(context, points, faces) {
    const drawn = new Set();
    context.beginPath();
    for (const face of faces) {
        face.forEach((corner, i) => {
            const next = face[(i + 1) % face.length];
            const name = Math.min(corner, next) * points.length + Math.max(corner, next);
            if (drawn.has(name))
                return;
            drawn.add(name);
            addToPath(context, [points[corner], points[next]]);
        });
    }
    context.stroke();
}

function drawText(context, text, x, y, colour, align) {
    context.textAlign = align;
    context.fillStyle = colour;
    context.fillText(text, x, y);
}

const LABEL_FONT = "700 12px system-ui, sans-serif";

/* Draws text centred at x, with an outline in the background colour. */
function drawLabel(context, text, x, y, colour) {
    context.font = LABEL_FONT;
    context.textAlign = "center";
    context.strokeStyle = stage.theme.card;
    context.lineWidth = 4;
    context.strokeText(text, x, y);
    drawText(context, text, x, y, colour, "center");
}

const RING_BELOW = 7;   /* pixels: a smaller box gets a ring, so that it is visible */

function drawRing(context, points) {
    const xs = points.map((p) => p[0]), ys = points.map((p) => p[1]);
    const low = [Math.min(...xs), Math.min(...ys)], high = [Math.max(...xs), Math.max(...ys)];
    if (Math.max(high[0] - low[0], high[1] - low[1]) >= RING_BELOW)
        return;
    context.beginPath();
    context.arc((low[0] + high[0]) / 2, (low[1] + high[1]) / 2, RING_BELOW, 0, 2 * Math.PI);
    context.stroke();
}

/* ---- Grid and axes ---- */

/* The distance of grid lines; 0 if doubles cannot distinguish or print them. */
function gridStep(range) {
    const size = unscaled(stage.units, range);
    return Number.isFinite(size) && size > 1e-300 ? niceStep(size) : 0;
}

/* Multiples of the step between two unit coordinates: {place, text}. Far from the origin, where all
 * labels would have the same digits, they are relative to the first frame. */
function gridLines(axis, low, high, step) {
    const origin = stage.units.origin[axis], far = Math.abs(origin) > 1e6 * step;
    const from = far ? 0 : origin, unit = scaled(stage.units, step), lines = [];
    const first = Math.ceil((from + unscaled(stage.units, low)) / step - 1e-9);
    for (let k = first; k < first + 60; k++) {
        const place = far ? k * unit : placed(stage.units, k * step, axis);
        if (!(place <= high + unit * 1e-9))
            break;
        const text = tickText(k * step, step);
        lines.push({ place, text: far && k >= 0 ? `+${text}` : text });
    }
    return lines;
}

function drawGrid2D(context, project) {
    const { camera, theme, width, height } = stage, { left, bottom } = plotMargins();
    const step = gridStep(90 / camera.zoom);
    if (step === 0)
        return;
    const zero = project([0, 0, 0]);
    context.font = "11px system-ui, sans-serif";
    context.strokeStyle = theme.grid;
    context.lineWidth = 1;
    const along = (axis, from, to) => gridLines(axis, from / camera.zoom, to / camera.zoom, step);
    for (const { place, text } of along(0, left - zero[0], width - zero[0])) {
        const x = Math.round(zero[0] + place * camera.zoom) + 0.5;
        drawLine(context, [x, 0], [x, height - bottom]);
        drawText(context, text, x, height - 8, theme.dim, "center");
    }
    for (const { place, text } of along(1, zero[1] - height + bottom, zero[1])) {
        const y = Math.round(zero[1] - place * camera.zoom) + 0.5;
        drawLine(context, [left, y], [width, y]);
        drawText(context, text, left - 6, y + 4, theme.dim, "right");
    }
    drawAxes2D(context, step);
}

function drawAxes2D(context, step) {
    const { units, theme, width, height } = stage, { left, bottom } = plotMargins();
    context.strokeStyle = theme.rule;
    drawLine(context, [left + 0.5, 0], [left + 0.5, height - bottom]);
    drawLine(context, [left, height - bottom - 0.5], [width, height - bottom - 0.5]);
    const names = ["x", "y"].map((name, axis) => Math.abs(units.origin[axis]) > 1e6 * step
        ? `${name} from ${digits(units.origin[axis], 17)}` : name);
    context.font = "600 11px system-ui, sans-serif";
    drawText(context, names[0], width - 8, height - bottom - 6, theme.dim, "right");
    drawText(context, names[1], left + 6, 14, theme.dim, "left");
}

/* Draws the grid below everything. */
function drawGrid3D(context, project) {
    const { low, high } = stage.camera.bounds, { theme, up } = stage;
    const axes = [0, 3 - up];
    const size = Math.max(...axes.map((axis) => high[axis] - low[axis]));
    const step = gridStep(Math.max(size, 1e-9) / 5);
    if (step === 0 || size === 0)
        return;
    const unit = scaled(stage.units, step);
    const ends = axes.map((axis) => [low[axis] - unit / 2, high[axis] + unit / 2]);
    context.strokeStyle = theme.grid;
    context.lineWidth = 1;
    axes.forEach((axis, k) => {
        const other = 1 - k;
        for (const { place } of gridLines(axis, ends[k][0], ends[k][1], step)) {
            const points = ends[other].map((end) => {
                const point = [...low];
                point[axis] = place;
                point[axes[other]] = end;
                return project(point);
            });
            drawLine(context, points[0], points[1]);
        }
    });
    context.font = "11px system-ui, sans-serif";
    drawText(context, `grid ${short(step)}`, stage.width - 10, stage.height - 10, theme.dim,
        "right");
}

/* Draws the directions of the axes in the lower left corner. */
function drawTriad(context) {
    const rotate = rotation(), at = [40, stage.height - 38];
    context.strokeStyle = stage.theme.dim;
    context.lineWidth = 1.4;
    context.font = "11px system-ui, sans-serif";
    ["x", "y", "z"].forEach((name, axis) => {
        const [right, up] = rotate([0, 1, 2].map((i) => i === axis ? 24 : 0));
        const beyond = [at[0] + 1.35 * right, at[1] - 1.35 * up + 4];
        drawLine(context, at, [at[0] + right, at[1] - up]);
        drawText(context, name, ...beyond, stage.theme.dim, "center");
    });
}

function drawGround(context, project) {
    if (stage.units.dim === 2) {
        drawGrid2D(context, project);
    } else {
        drawGrid3D(context, project);
        drawTriad(context);
    }
}
