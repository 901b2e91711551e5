/* The scene of the chosen query: its frames and its camera. */

/* Queries with the same bodies are steps of one motion, and share a camera. */
const cameras = new Map();

/* ---- Loading an event ---- */

/* The frames that one picture can show: those with the dimension of the first. */
function drawableFrames(event) {
    const frames = framesOf(event), first = frames.find((frame) => frame.shape);
    for (const frame of frames) {
        if (frame.shape && frame.shape.dim !== first.shape.dim) {
            frame.why = `it is of ${frame.shape.dim}D, and others are not`;
            frame.shape = null;
        }
    }
    return frames;
}

function worstOfFrames(event, pairs) {
    const worst = event.frames.map(() => NO_VERDICT);
    for (const pair of pairs)
        for (const index of [pair.a, pair.b])
            worst[index] = Math.max(worst[index] ?? NO_VERDICT, verdictOf(pair.now ?? pair.then));
    const answer = answerOf(event);
    const isWhole = answer && event.kind >= KIND_ALL && event.first === 0
        && answer.end >= event.total && !event.more;
    const others = isWhole ? SEPARATED : NO_VERDICT;
    return worst.map((verdict) => Math.max(verdict, others));
}

function groupOf(event, drawable) {
    return `${drawable[0].shape.dim}:${event.frames.map((frame) => frame[0]).join(" ")}`;
}

/* Whether the camera also suits this event: the event is inside its bounds, and not too small in
 * them. */
function fits(camera, bounds) {
    const all = camera.bounds, step = extent(all) * 0.02;
    return extent(bounds) > extent(all) / 8
        && [0, 1, 2].every((axis) => bounds.low[axis] >= all.low[axis] - step
            && bounds.high[axis] <= all.high[axis] + step);
}

function setScene(event) {
    stage.event = event;
    stage.pairs = pairsOf(event);
    stage.frames = drawableFrames(event);
    stage.worst = worstOfFrames(event, stage.pairs);
    stage.drawable = stage.frames.filter((frame) => frame.shape);
    stage.moment = 0;
    stage.pointed = -1;
    stage.camera = null;
    measureStage();
    if (stage.drawable.length > 0)
        setCamera(event);
    setSolids(event);
    drawBands();
    redrawStage();
}

/* Sets the solids of the raster: a group for each body, with polygons divided into triangles. */
function setSolids(event) {
    let count = 0;
    stage.solids = stage.drawable.map((frame) => {
        const outline = outlineOf(stage.units, frame, event.T), first = count;
        const fans = outline.faces.map((face) => face.slice(2).map((k, i) => [face[0], face[i + 1], k]));
        count += fans.length;
        return {
            ...outline, frame, first, corner: Float64Array.from(outline.corners.flat()),
            face: fans.flat(2), id: fans.flatMap((fan, i) => fan.map(() => first + i)),
            light: outline.faces.map((face) => stage.units.dim === 2 ? 0.8
                : lightOf(...face.slice(0, 3).map((k) => outline.corners[k]))),
        };
    });
    allotFaces(count);
}

/* Reuses the camera of the group if it suits the event; otherwise makes a new one. */
function setCamera(event) {
    const group = groupOf(event, stage.drawable), old = cameras.get(group);
    const bounds = old && boundsOf(old.units, stage.drawable, event.T);
    if (old && fits(old, bounds)) {
        Object.assign(stage, { units: old.units, camera: old, bounds });
        return;
    }
    const { dim } = stage.drawable[0].shape;
    stage.units = makeUnits(dim, stage.drawable, event.T);
    stage.bounds = boundsOf(stage.units, stage.drawable, event.T);
    stage.camera = { units: stage.units, bounds: widened(event, stage.units, stage.bounds) };
    cameras.set(group, stage.camera);
    fit(stage.camera.bounds);
}

/* Bounds that also contain neighbouring queries with the same bodies, as long as these are of
 * similar size. */
const AROUND = 300, AROUND_FRAMES = 200;

function widened(event, units, bounds) {
    const group = groupOf(event, stage.drawable), size = extent(bounds);
    let all = bounds;
    if (stage.drawable.length > AROUND_FRAMES)
        return all;
    for (const other of events.slice(Math.max(event.at - AROUND, 0), event.at + AROUND)) {
        if (other === event || other.frames.length !== event.frames.length)
            continue;
        const frames = drawableFrames(other).filter((frame) => frame.shape);
        if (frames.length === 0 || groupOf(other, frames) !== group)
            continue;
        const joined = boundsOfPoints([...all.points, ...boundsOf(units, frames, other.T).points]);
        if (extent(joined) < 4 * size)
            all = joined;
    }
    return all;
}

/* ---- Fitting the view ---- */

function fitAll() {
    if (!stage.camera)
        return;
    stage.camera.bounds = stage.bounds;
    fit(stage.bounds);
    redrawStage();
}

/* Fits the frames of the chosen pair at the current moment, and its boxes. */
function fitPair() {
    const pair = chosenPair();
    if (!stage.camera || !pair)
        return;
    const frames = [pair.a, pair.b].map((index) => stage.frames[index])
        .filter((frame) => frame?.shape);
    if (frames.length === 0)
        return;
    fit(boundsOf(stage.units, frames, stage.event.T));
    redrawStage();
}
