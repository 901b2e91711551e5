/* The moment of the window to show: a slider, a play button, and bands above the slider where there
 * is contact. The moment is a fraction of stage.event.T seconds. */

const PLAY_SECONDS = 3;
const player = { running: false, before: 0 };

/* ---- Bands ---- */

function percent(part) {
    return `${(100 * clamp(part, 0, 1)).toFixed(3)}%`;
}

function makeBand(kind, times, T, label) {
    const band = make("div", { class: `band ${kind}`, title: label });
    band.style.left = percent(times[0] / T);
    band.style.width = `max(3px, ${percent(times[1] / T - times[0] / T)})`;
    return band;
}

/* ---- The moment ---- */

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
