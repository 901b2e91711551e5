/* Draws the scene of the chosen query: bodies at a moment of the window, coloured by verdict;
 * dashed outlines at the end of the window; arrows along the motion; boxes of contacts. 2D is drawn
 * in the plane, 3D can be rotated with the mouse. */

const LABELS_MAX = 80;  /* with more bodies ids show only at the pointer */
const BOXES_MAX = 2000;
const ARROW_MIN = 5;

/* ---- Frames ---- */

/* Frames outside the chosen pair are dimmed. */
function isDimmed(index) {
    const pair = chosenPair();
    return pair && index !== pair.a && index !== pair.b;
}

const COVER_2D = 0.5, COVER_3D = 0.66;
const EDGE_DARK = 0.7;

function shadeFaces() {
    for (const { frame, first, light } of stage.solids) {
        const cover = (stage.units.dim === 2 ? COVER_2D : COVER_3D)
            * (isDimmed(frame.index) ? 0.4 : 1);
        light.forEach((value, i) => {
            shadeFace(first + i, COLOURS[stage.worst[frame.index]], value);
            faces.cover[first + i] = cover;
            faces.group[first + i] = frame.index;
        });
    }
}

/* Drawn behind the faces, except for the body at the pointer: hidden edges show faintly through the
 * faces. Bodies without a visible face show here. */
function drawOutlines(context, project) {
    for (const solid of stage.solids) {
        const { index } = solid.frame;
        context.lineWidth = index === stage.pointed ? 3.6 : 2;
        context.strokeStyle = strokeOf(stage.worst[index], isDimmed(index) ? 0.45 : 1);
        drawEdges(context, cornersAt(solid, stage.moment).map(project), solid.faces);
    }
}

/* ---- Motion ---- */

function moves(frame) {
    return frame.velocity !== null && frame.velocity.some((value) => value !== 0);
}

function drawHead(context, from, to) {
    const length = Math.hypot(to[0] - from[0], to[1] - from[1]);
    const [x, y] = [(to[0] - from[0]) / length, (to[1] - from[1]) / length];
    tracePolygon(context, [to, [to[0] - 9 * x - 4 * y, to[1] - 9 * y + 4 * x],
        [to[0] - 9 * x + 4 * y, to[1] - 9 * y - 4 * x]]);
    context.fill();
}

/* A window of length 0 has a direction only. */
function arrowEnd(project, { frame, middle, shift }, from) {
    if (stage.event.T > 0)
        return project(plus(middle, shift, 1));
    const largest = Math.max(...frame.velocity.map(Math.abs));
    const direction = [0, 1, 2].map((axis) => middle[axis] + (frame.velocity[axis] ?? 0) / largest);
    const to = project(direction), length = Math.hypot(to[0] - from[0], to[1] - from[1]);
    return length < 1e-9 ? to : from.map((value, i) => value + (to[i] - value) * 36 / length);
}

function drawMotion(context, project, solid) {
    const { index } = solid.frame;
    if (stage.event.T > 0) {
        context.setLineDash([4, 4]);
        context.lineWidth = 1.1;
        context.strokeStyle = strokeOf(stage.worst[index], isDimmed(index) ? 0.25 : 0.85);
        drawEdges(context, cornersAt(solid, 1).map(project), solid.faces);
        context.setLineDash([]);
    }
    const from = project(plus(solid.middle, solid.shift, stage.moment));
    const to = arrowEnd(project, solid, from);
    const length = Math.hypot(to[0] - from[0], to[1] - from[1]);
    if (!(length >= ARROW_MIN))
        return;
    context.globalAlpha = isDimmed(index) ? 0.25 : 1;
    context.strokeStyle = context.fillStyle = stage.theme.ink;
    context.lineWidth = 1.6;
    drawLine(context, from, to);
    drawHead(context, from, to);
    context.globalAlpha = 1;
}

/* ---- Boxes ---- */

/* More boxes than this are drawn lightly. */
const CROWD = 150;

function drawBox(context, project, box, then) {
    const outline = outlineOfBox(stage.units, box), points = outline.corners.map(project);
    context.strokeStyle = then ? stage.theme.diff : stage.theme.box;
    context.fillStyle = stage.theme.box;
    context.lineWidth = then ? 2 : stage.pairs.length > CROWD ? 0.8 : 1.7;
    context.setLineDash(then ? [7, 4] : []);
    const alpha = context.globalAlpha;
    context.globalAlpha = alpha * (stage.units.dim === 3 ? 0.09 : 0.18);
    for (const face of then ? [] : outline.faces)
        if (tracePolygon(context, face.map((k) => points[k])))
            context.fill();
    context.globalAlpha = alpha;
    drawEdges(context, points, outline.faces);
    if (stage.pairs.length <= CROWD || context.globalAlpha === 1)
        drawRing(context, points);
    context.setLineDash([]);
}

/* The new box of a contact, and the recorded one if it differs or there is no new one. */
function boxesOf(pair) {
    const then = boxOf(pair.then), now = boxOf(pair.now);
    const differs = pair.differs && then && JSON.stringify(then) !== JSON.stringify(now);
    return { now: now ?? (pair.differs ? null : then), then: differs ? then : null };
}

function drawBoxes(context, project) {
    let count = 0;
    for (const pair of stage.pairs) {
        const boxes = boxesOf(pair), chosenOne = chosenPair();
        const isDrawn = (box) => box && box[0].length === stage.units.dim && count++ < BOXES_MAX;
        context.globalAlpha = chosenOne && chosenOne.index !== pair.index ? 0.2
            : chosenOne || stage.pairs.length <= CROWD ? 1 : 0.45;
        if (isDrawn(boxes.now))
            drawBox(context, project, boxes.now, false);
        if (isDrawn(boxes.then))
            drawBox(context, project, boxes.then, true);
    }
    context.globalAlpha = 1;
}

/* ---- Gaps ---- */

/* Draws the segment between the nearest points of two bodies. */
function drawGaps(context, project) {
    const { dim } = stage.units, one = chosenPair();
    context.strokeStyle = stage.theme.link;
    context.lineWidth = 1.6;
    context.setLineDash([2, 3]);
    for (const pair of one ? [one] : stage.pairs.slice(0, BOXES_MAX)) {
        const points = gapOf(pair.now)?.slice(3) ?? [];
        const [from, to] = [points.slice(0, dim), points.slice(dim)].map((point) => [0, 1, 2].map(
            (axis) => axis < dim ? clamp(boxEnd(stage.units, point[axis], axis, 1), -CUT, CUT) : 0));
        if (points.length === 2 * dim)
            drawLine(context, project(from), project(to));
    }
    context.setLineDash([]);
}

/* ---- Labels ---- */

const LABEL_PLACES = [[0, 0], [0, -14], [0, 14], [16, 0], [-16, 0], [16, -14], [-16, 14], [16, 14],
    [-16, -14], [0, -28], [0, 28]];

function collides(a, b) {
    return Math.abs(a.x - b.x) < a.half + b.half + 2 && Math.abs(a.y - b.y) < 13;
}

/* The first free place near the wanted one; otherwise the wanted one. */
function placeLabel(wanted, labels) {
    for (const [x, y] of LABEL_PLACES) {
        const label = { ...wanted, x: wanted.x + x, y: wanted.y + y };
        if (!labels.some((other) => collides(label, other)))
            return label;
    }
    return wanted;
}

function isLabelled(frame) {
    const pair = chosenPair();
    if (frame.index === stage.pointed)
        return true;
    if (pair && stage.drawable.length > 12)
        return frame.index === pair.a || frame.index === pair.b;
    return stage.drawable.length <= LABELS_MAX;
}

function drawLabels(context, project) {
    const labels = [];
    context.font = LABEL_FONT;
    for (const { frame, middle, shift } of stage.solids) {
        if (!isLabelled(frame))
            continue;
        const [x, y] = project(plus(middle, shift, stage.moment)), text = bodyName(frame.id);
        const half = context.measureText(text).width / 2;
        labels.push(placeLabel({ x, y, half, text, index: frame.index }, labels));
    }
    for (const { x, y, text, index } of labels) {
        context.globalAlpha = isDimmed(index) && index !== stage.pointed ? 0.4 : 1;
        drawLabel(context, text, x, y + 4, stage.theme.ink);
    }
    context.globalAlpha = 1;
}

/* ---- The picture ---- */

function drawScene(context, project) {
    drawGround(context, project);
    context.save();
    if (stage.units.dim === 2) {
        context.beginPath();
        context.rect(plotMargins().left, 0, stage.width, stage.height - plotMargins().bottom);
        context.clip();
    }
    drawOutlines(context, project);
    drawFaces(context, project, EDGE_DARK);
    drawBoxes(context, project);
    drawGaps(context, project);
    for (const solid of stage.solids)
        if (moves(solid.frame))
            drawMotion(context, project, solid);
    drawLabels(context, project);
    context.restore();
}
