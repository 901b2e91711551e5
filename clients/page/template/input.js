/* Input on the stage: mouse, keyboard, and the buttons around it. Each page defines fitAll(),
 * fitPair(), redrawStage() and point(), which gets a position on the stage or null. */

/* Shows a text next to the pointer; at: null hides it. */
function showTip(at, text) {
    const tip = find("pointed");
    tip.hidden = at === null;
    if (at === null)
        return;
    tip.textContent = text;
    tip.style.left = `${clamp(at.x + 14, 0, stage.width - 200)}px`;
    tip.style.top = `${clamp(at.y + 14, 0, stage.height - 40)}px`;
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
        const begin = camera && { ...pointIn("stage", mouse), pan: camera.pan, azimuth, elevation };
        point(null);
        return begin && ((moved) => {
            if (stage.camera === camera)
                dragStage(begin, pointIn("stage", moved), pans);
        });
    });
    canvas.addEventListener("pointermove", (mouse) => {
        point(mouse.buttons ? null : pointIn("stage", mouse));
    });
    canvas.addEventListener("pointerleave", () => point(null));
    canvas.addEventListener("contextmenu", (mouse) => mouse.preventDefault());
}

function setDirection(name) {
    Object.assign(stage, viewOf(name));
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
        const { x, y } = pointIn("stage", wheel);
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

/* keys: functions by the name of the key. Input fields keep all keys. Buttons keep the space key,
 * and so does the page if the window cannot be played. */
function listenToKeys(keys) {
    document.addEventListener("keydown", (key) => {
        const own = key.target.closest("input, select, textarea")
            || (key.key === " " && (key.target.closest("button, summary") || find("window").hidden));
        if (own || key.ctrlKey || key.metaKey || key.altKey || !Object.hasOwn(keys, key.key))
            return;
        key.preventDefault();
        keys[key.key](key);
    });
}
