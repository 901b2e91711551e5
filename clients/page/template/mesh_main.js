/* The selection, keyboard commands, and the start. */

const chosen = { pair: null };

/* comes: moves the camera to the pair, at the time of its first contact. */
function choosePair(pair, comes) {
    chosen.pair = pair;
    if (pair && isMoving) {
        stopPlaying();
        stage.moment = clamp(pair.times[0] / data.T, 0, 1);
        showMoment();
    }
    find("fit-pair").disabled = !pair;
    find("announce").textContent = pair ? `${pairName(pair)}: ${verdictName(pair.verdict)}` : "";
    showChosenRow();
    drawBands();
    if (pair && comes)
        fitPair();
    redrawStage();
}

function stepPair(by) {
    const { list } = panel, at = list.indexOf(chosen.pair);
    if (list.length > 0)
        choosePair(list[at < 0 ? 0 : (at + by + list.length) % list.length], true);
}

const KEY_TURN = Math.PI / 24;

function turnBy(azimuth, elevation) {
    stage.azimuth += azimuth;
    stage.elevation = clamp(stage.elevation + elevation, -Math.PI / 2, Math.PI / 2);
    redrawStage();
}

function zoomBy(factor) {
    zoomStage(factor, stage.width / 2, stage.height / 2);
}

const KEYS = {
    ArrowLeft: () => turnBy(KEY_TURN, 0),
    ArrowRight: () => turnBy(-KEY_TURN, 0),
    ArrowUp: () => turnBy(0, KEY_TURN),
    ArrowDown: () => turnBy(0, -KEY_TURN),
    "+": () => zoomBy(1.25),
    "-": () => zoomBy(0.8),
    0: fitAll,
    n: () => stepPair(1),
    p: () => stepPair(-1),
    " ": togglePlaying,
    Escape: () => choosePair(null, false),
};

/* A press that moves further than this is a drag, not a click. */
const STILL = 4; /* pixels */

function listenToClicks() {
    const canvas = find("stage");
    let pressed = null;
    canvas.addEventListener("pointerdown", (mouse) => {
        pressed = pointIn("stage", mouse);
    });
    canvas.addEventListener("click", (mouse) => {
        const at = pointIn("stage", mouse);
        if (pressed && Math.hypot(at.x - pressed.x, at.y - pressed.y) < STILL)
            chooseBelow(at);
    });
}

function listen() {
    listenToKeys(KEYS);
    listenToClicks();
    find("list").addEventListener("click", (click) => {
        const row = click.target.closest("tr");
        if (row)
            choosePair(pairs[Number(row.dataset.pair)], true);
    });
    find("filter").addEventListener("input", applyFilter);
    find("verdict").addEventListener("change", applyFilter);
    find("more").addEventListener("click", () => {
        panel.rows += ROWS_MORE;
        fillList();
    });
    find("up-y").addEventListener("click", () => setUp(1));
    find("up-z").addEventListener("click", () => setUp(2));
    find("previous").addEventListener("click", () => stepPair(-1));
    find("next").addEventListener("click", () => stepPair(1));
}

function readUnits() {
    const power = -data.exponent;
    stage.units = { dim: 3, origin: data.centre, power, factor: factors(power) };
    stage.event = { T: data.T };
    stage.moment = isMoving && pairs.length > 0 ? clamp(timesOfAll()[0] / data.T, 0, 1) : 0;
}

function start() {
    fillHeader();
    fillNotes();
    fillFacts();
    fillLegend();
    fillList();
    readUnits();
    groupFaces();
    stage.solids = meshes;
    stage.edge = meanEdge();
    measureStage();
    stage.camera = { bounds: boundsNow() };
    setUp(2);
    find("fit-pair").disabled = true;
    for (const id of ["filter", "verdict", "previous", "next"])
        find(id).disabled = pairs.length === 0;
    find("stage").setAttribute("aria-label", "The meshes, and their faces that meet");
    startStage();
    listen();
    drawBands();
    if (isMoving)
        showMoment();
}

start();
