/* The moment of the window that is shown: a slider, the contact intervals above it, a button that
 * lets it run. And the mouse on the stage. */

const PLAY_SECONDS = 3;
const player = { running: false, before: 0 };

function isMoving(event) {
    return event.T > 0 && stage.drawable.some((frame) => frame.velocity !== null);
}

/* ---- Bands: when there is contact ---- */

function percent(part) {
    return `${(100 * clamp(part, 0, 1)).toFixed(3)}%`;
}

function makeBand(kind, times, T, said) {
    const band = make("div", { class: `band ${kind}`, title: said });
    band.style.left = percent(times[0] / T);
    band.style.width = `max(3px, ${percent(times[1] / T - times[0] / T)})`;
    return band;
}

/* [times now, times then where they differ] */
function timesOfPair(pair) {
    const then = timesOf(pair.then), now = timesOf(pair.now);
    const differs = pair.differs && then && (!now || now[0] !== then[0] || now[1] !== then[1]);
    return [now ?? (pair.differs ? null : then), differs ? then : null];
}

function bandsOf(event) {
    const pair = chosenPair(), bands = [];
    for (const of of pair ? [pair] : stage.pairs.slice(0, BOXES_MAX)) {
        const [now, then] = timesOfPair(of), name = of.ids.map(bodyName).join(" – ");
        if (now)
            bands.push(makeBand(VERDICTS[verdictOf(of.now ?? of.then)], now, event.T,
                `${name}: in contact ${intervalText(...now)} s`));
        if (then)
            bands.push(makeBand("then", then, event.T,
                `${name}: then in contact ${intervalText(...then)} s`));
    }
    return bands;
}

function drawBands() {
    const event = stage.event, moving = isMoving(event);
    find("window").hidden = !moving;
    stopPlaying();
    if (moving)
        show(find("bands"), ...bandsOf(event));
    showMoment();
}

function showMoment() {
    const { event, moment } = stage;
    find("moment").value = String(Math.round(moment * 1000));
    find("moment-said").textContent = `${short(moment * event.T)} s of ${short(event.T)} s`;
}

function setMoment(moment) {
    stage.moment = clamp(moment, 0, 1);
    showMoment();
    redrawStage();
}

/* ---- Playing ---- */

function stopPlaying() {
    player.running = false;
    find("play").textContent = "▶";
}

function playOn(now) {
    if (!player.running)
        return;
    setMoment(stage.moment + (now - player.before) / 1000 / PLAY_SECONDS);
    player.before = now;
    if (stage.moment >= 1)
        stopPlaying();
    else
        requestAnimationFrame(playOn);
}

function togglePlaying() {
    if (find("window").hidden)
        return;
    if (player.running) {
        stopPlaying();
        return;
    }
    if (stage.moment >= 1)
        stage.moment = 0;
    player.running = true;
    player.before = performance.now();
    find("play").textContent = "❚❚";
    requestAnimationFrame(playOn);
}

/* ---- Mouse ---- */

function stagePoint(mouse) {
    const box = find("stage").getBoundingClientRect();
    return { x: mouse.clientX - box.left, y: mouse.clientY - box.top };
}

const TURN = 0.008; /* radians a pixel */

function dragStage(begin, point, pans) {
    const { camera } = stage, moved = [point.x - begin.x, point.y - begin.y];
    if (stage.units.dim === 2 || pans) {
        camera.pan = begin.pan.map((pan, axis) => pan + moved[axis]);
    } else {
        stage.azimuth = begin.azimuth - moved[0] * TURN;
        stage.elevation = clamp(begin.elevation + moved[1] * TURN, -Math.PI / 2, Math.PI / 2);
    }
    redrawStage();
}

function listenToStageDrag(canvas) {
    listenToDrags(canvas, (mouse) => {
        const { azimuth, elevation, camera } = stage, pans = mouse.shiftKey || mouse.button !== 0;
        const begin = camera && { ...stagePoint(mouse), pan: camera.pan, azimuth, elevation };
        point(null);
        return begin && ((moved) => {
            if (stage.camera === camera)
                dragStage(begin, stagePoint(moved), pans);
        });
    });
    canvas.addEventListener("pointermove", (mouse) => {
        point(mouse.buttons ? null : stagePoint(mouse));
    });
    canvas.addEventListener("pointerleave", () => point(null));
    canvas.addEventListener("contextmenu", (mouse) => mouse.preventDefault());
}

/* The nearest face below the pointer. */
function point(at) {
    let index = -1;
    for (const facet of at ? stage.facets : [])
        if (isInside(facet.points, at.x, at.y))
            index = facet.index;
    const tip = find("pointed");
    tip.hidden = index < 0;
    if (index >= 0) {
        const frame = stage.frames[index];
        tip.textContent = `body ${bodyName(frame.id)}, ${shapeName(frame.shape)}: `
            + verdictName(stage.worst[index]);
        tip.style.left = `${clamp(at.x + 14, 0, stage.width - 200)}px`;
        tip.style.top = `${clamp(at.y + 14, 0, stage.height - 40)}px`;
    }
    if (index !== stage.pointed) {
        stage.pointed = index;
        redrawStage();
    }
}

function setDirection(name) {
    Object.assign(stage, VIEWS[name]);
    if (stage.camera)
        fit(stage.camera.bounds);
    redrawStage();
}

function startStage() {
    const canvas = find("stage");
    readTheme();
    listenToStageDrag(canvas);
    canvas.addEventListener("wheel", (wheel) => {
        wheel.preventDefault();
        const { x, y } = stagePoint(wheel);
        if (stage.camera)
            zoomStage(1 / wheelFactor(wheel), x, y);
    }, { passive: false });
    canvas.addEventListener("dblclick", fitAll);
    find("fit-all").addEventListener("click", fitAll);
    find("fit-pair").addEventListener("click", fitPair);
    for (const button of find("views").children)
        button.addEventListener("click", () => setDirection(button.dataset.view));
    find("moment").addEventListener("input", (input) => {
        setMoment(Number(input.target.value) / 1000);
    });
    find("play").addEventListener("click", togglePlaying);
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => {
        readTheme();
        redrawStage();
    });
    new ResizeObserver(redrawStage).observe(canvas);
}
