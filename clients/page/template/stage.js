/* The scene of the chosen query, drawn on a canvas: frames at a moment of the window in the colours
 * of their verdicts, dashed where they are at its end, arrows on the way, the boxes of the
 * contacts. 2D as it lies in the plane, 3D turned as the mouse turns it. */

const LABELS_MAX = 80;  /* more bodies cannot be labelled: their ids show when pointed at */
const BOXES_MAX = 2000;
const ARROW_MIN = 5;

/* ---- Frames ---- */

/* Frames that do not belong to the chosen pair step back. */
function isBack(index) {
    const pair = chosenPair();
    return pair && index !== pair.a && index !== pair.b;
}

/* A face of a solid is turned to the viewer where its normal, pointed away from the middle of the
 * frame, is. */
function isFront(points, middle) {
    const normal = cross(minus(points[1], points[0]), minus(points[2], points[0]));
    const out = dot(normal, minus(middleOf(points), middle));
    return out >= 0 ? normal[2] >= 0 : normal[2] <= 0;
}

/* Right, up, depth, for the sake of isFront: y grows downwards on the canvas. */
function standing(point) {
    return [point[0], -point[1], point[2] * stage.camera.zoom];
}

/* Faces, and how near they are. */
function facetsOf(project, frame, outline) {
    const points = outline.corners.map(project);
    return outline.faces.map((face, i) => {
        const middle = outline.middles[i];
        const corners = face.map((k) => points[k]), world = face.map((k) => outline.corners[k]);
        return {
            index: frame.index, face, points: corners, flat: stage.units.dim === 2,
            depth: corners.reduce((sum, p) => sum + p[2], 0) / corners.length,
            light: stage.units.dim === 2 ? 0.8 : lightOf(world[0], world[1], world[2]),
            front: middle === null
                || isFront(corners.map(standing), standing(project(middle))),
        };
    });
}

/* How far back, 0 to 1, on the way through all that is drawn. */
function depthCue(facets) {
    let near = -Infinity, far = Infinity;
    for (const { depth } of facets) {
        near = Math.max(near, depth);
        far = Math.min(far, depth);
    }
    return (depth) => near > far ? (near - depth) / (near - far) : 0;
}

function drawFacet(context, facet, behind) {
    const verdict = stage.worst[facet.index], back = isBack(facet.index);
    const pointed = facet.index === stage.pointed;
    const strength = (back ? 0.45 : 1) * (1 - 0.45 * behind);
    if (!tracePolygon(context, facet.points))
        return;
    if (!facet.front) {
        context.lineWidth = 0.7;
        context.strokeStyle = strokeOf(verdict, 0.45 * strength);
        context.stroke();
        return;
    }
    const cover = (facet.flat ? 0.5 : 0.66) * (back ? 0.4 : 1 - 0.3 * behind);
    context.fillStyle = colourOf(verdict, facet.light, cover);
    context.fill();
    context.lineWidth = pointed ? 2.4 : facet.flat ? 1.5 : 1.2;
    context.strokeStyle = strokeOf(verdict, pointed ? 1 : strength);
    context.stroke();
}

function drawFrames(context, project, time) {
    stage.outlines = stage.drawable.map((frame) => outlineOf(stage.units, frame, time));
    const facets = stage.drawable.flatMap((frame, i) =>
        facetsOf(project, frame, stage.outlines[i]));
    facets.sort((a, b) => a.depth - b.depth);
    const cue = depthCue(facets);
    facets.forEach((facet) => drawFacet(context, facet, cue(facet.depth)));
    stage.facets = facets.filter((facet) => facet.front);
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

/* Where the window has no length there is a direction only. */
function arrowEnd(project, frame, from, middle) {
    if (stage.event.T > 0)
        return project(outlineOf(stage.units, frame, stage.event.T).middle);
    const largest = Math.max(...frame.velocity.map(Math.abs));
    const direction = [0, 1, 2].map((axis) => middle[axis] + (frame.velocity[axis] ?? 0) / largest);
    const to = project(direction), length = Math.hypot(to[0] - from[0], to[1] - from[1]);
    return length < 1e-9 ? to : from.map((value, i) => value + (to[i] - value) * 36 / length);
}

function drawMotion(context, project, frame, outline) {
    const verdict = stage.worst[frame.index], alpha = isBack(frame.index) ? 0.25 : 0.85;
    if (stage.event.T > 0) {
        const end = outlineOf(stage.units, frame, stage.event.T);
        context.setLineDash([4, 4]);
        context.lineWidth = 1.1;
        context.strokeStyle = strokeOf(verdict, alpha);
        drawEdges(context, end.corners.map(project), facetsOf(project, frame, end)
            .filter((facet) => facet.front).map((facet) => facet.face));
        context.setLineDash([]);
    }
    const from = project(outline.middle), to = arrowEnd(project, frame, from, outline.middle);
    const length = Math.hypot(to[0] - from[0], to[1] - from[1]);
    if (!(length >= ARROW_MIN))
        return;
    context.globalAlpha = isBack(frame.index) ? 0.25 : 1;
    context.strokeStyle = context.fillStyle = stage.theme.ink;
    context.lineWidth = 1.6;
    drawLine(context, from, to);
    drawHead(context, from, to);
    context.globalAlpha = 1;
}

/* ---- Boxes ---- */

/* Many boxes are drawn lightly. */
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

/* As it is now; as it was then where it differs, or where there is none now. */
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

/* ---- Labels ---- */

const LABEL_PLACES = [[0, 0], [0, -14], [0, 14], [16, 0], [-16, 0], [16, -14], [-16, 14], [16, 14],
    [-16, -14], [0, -28], [0, 28]];

function collides(a, b) {
    return Math.abs(a.x - b.x) < a.half + b.half + 2 && Math.abs(a.y - b.y) < 13;
}

/* The first place near the wanted one where no label stands yet; else the wanted one. */
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
    context.lineJoin = "round";
    stage.drawable.forEach((frame, i) => {
        if (!isLabelled(frame))
            return;
        const [x, y] = project(stage.outlines[i].middle), text = bodyName(frame.id);
        const half = context.measureText(text).width / 2;
        labels.push(placeLabel({ x, y, half, text, index: frame.index }, labels));
    });
    for (const { x, y, text, index } of labels) {
        context.globalAlpha = isBack(index) && index !== stage.pointed ? 0.4 : 1;
        drawLabel(context, text, x, y + 4, stage.theme.ink);
    }
    context.globalAlpha = 1;
}

/* ---- The picture ---- */

function drawStage() {
    const context = clearStage();
    stage.facets = [];
    if (!stage.camera)
        return;
    const project = projection(), time = stage.moment * stage.event.T;
    if (stage.units.dim === 2) {
        drawGrid2D(context, project);
    } else {
        drawGrid3D(context, project);
        drawTriad(context);
    }
    context.save();
    if (stage.units.dim === 2) {
        context.beginPath();
        context.rect(inner().left, 0, stage.width, stage.height - inner().bottom);
        context.clip();
    }
    context.lineJoin = "round";
    drawFrames(context, project, time);
    drawBoxes(context, project);
    stage.drawable.forEach((frame, i) => {
        if (moves(frame))
            drawMotion(context, project, frame, stage.outlines[i]);
    });
    drawLabels(context, project);
    context.restore();
}

const redrawStage = onceAFrame(drawStage);
