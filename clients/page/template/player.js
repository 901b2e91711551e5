/* The clock, the moment that is shown, and what moves it. */

const player = { s: 0, playing: false, last: 0, busy: 0 };
const heads = document.querySelectorAll(".track .head");
const canPlay = steps.length > 1 || steps.some((step) => step.moves);

/* Shows the moment player.s. While it plays, table and time follow five times a second at most: painting them
 * takes longer than drawing the scene. */
function show() {
    const i = stepAt(player.s), head = (player.s - view.from) / (view.to - view.from);
    const isDue = !player.playing || performance.now() - table.time > (pace.scale < 1 ? 500 : 200);
    if (isDue) {
        table.time = performance.now();
        document.documentElement.style.setProperty("--lane-head", head);
        one("moment").textContent = momentText(i);
        one("play").textContent = player.playing ? "❚❚" : "▶";
    }
    if (isDue && i !== table.step) {
        table.step = i;
        if (!player.playing && table.sort !== null)
            chooseRows();
        fillRows();
        drawDetail();
    }
    drawMoment(i, player.s);
    if (!player.playing || Math.abs(one("scrub").value - player.s) > wholeSpan / 1400)
        one("scrub").value = player.s;
    heads.forEach((each) => { each.style.transform = `translateX(${Math.round(head * view.width)}px)`; });
}

function momentText(i) {
    if (steps.length === 0)
        return "nothing to show";
    const time = unit ? `${timeOf(player.s).toFixed(3)} s` : "";
    return [time, steps.length > 1 ? `step ${i + 1} of ${steps.length}` : "", steps[i].label ?? ""].filter(Boolean).join(" · ");
}

/* Browsers refuse more than about 20 changes a second, and then other navigation too: the address follows when
 * the moment has not moved for a while. */
let hashTimer = 0;

function setHash() {
    clearTimeout(hashTimer);
    hashTimer = setTimeout(() => {
        try {
            history.replaceState(null, "", `#t=${Number(timeOf(player.s).toFixed(6))}`);
        } catch (error) { /* of a page inside another one: the link stays as it was */ }
    }, 100);
}

function seek(s) {
    player.s = Math.min(Math.max(s, 0), wholeSpan);
    if (player.s < view.from || player.s > view.to)
        setView(0, wholeSpan);
    show();
    if (!player.playing)
        setHash();
}

function play(on = !player.playing) {
    player.playing = on && canPlay;
    if (player.playing && player.s >= wholeSpan)
        player.s = 0;
    table.time = -Infinity; /* at once */
    show();
    if (!player.playing) {
        if (table.sort !== null)
            chooseRows();
        setHash();
    }
}

/* Advances by the time that has passed; at the end it begins again, or stops. */
function tick(now) {
    const begin = performance.now(), passed = now - player.last;
    player.last = now;
    followPace(player.playing || stage.turning, passed - player.busy);
    if (player.playing) {
        /* scenes without duration: ten a second; windows shorter than a second in one */
        const rate = Number(one("speed").value) * (unit ? steps.length > 1 ? 1 : Math.min(wholeSpan / 2, 1) : 10);
        const s = player.s + passed / 1000 * rate;
        player.s = s <= wholeSpan ? s : one("loop").checked ? s % wholeSpan : wholeSpan;
        if (player.s === wholeSpan && !one("loop").checked)
            play(false);
        else
            show();
    }
    drawScene();
    player.busy = performance.now() - begin;
    requestAnimationFrame(tick);
}

/* ---- Steps ---- */

/* The next step, or the one before; of one step, a twentieth of its window. */
function move(by) {
    play(false);
    if (steps.length > 1)
        seek(begins[Math.min(Math.max(stepAt(player.s) + by, 0), steps.length - 1)]);
    else
        seek(player.s + by * wholeSpan / 20);
}

/* The first of ascending times after this moment, or before it; else from the other end. */
function jump(times, by) {
    play(false);
    const small = 1e-9 * wholeSpan;
    const found = by > 0 ? times.find((s) => s > player.s + small) : times.filter((s) => s < player.s - small).pop();
    if (times.length > 0)
        seek(found ?? (by > 0 ? times[0] : times[times.length - 1]));
}

const nextContact = (by = 1) => jump(contacts(), by);
const nextDifference = (by = 1) => {
    jump(differences.map((i) => begins[i]), by);
    const row = rows.find((each) => isDifferent(pairAt(each, stepAt(player.s)) ?? []));
    if (row && row !== stage.row)
        choose(row);
};

/* ---- The shown part of the time ---- */

function setView(from, to) {
    const span = Math.min(Math.max(to - from, wholeSpan / 1e5), wholeSpan);
    view.from = Math.min(Math.max(from, 0), wholeSpan - span);
    view.to = view.from + span;
    drawTime();
}

function drawTime() {
    drawOverview();
    drawLanes();
    drawGap(stage.row);
    show();
}

function sUnder(event, element) {
    const box = element.getBoundingClientRect();
    return view.from + (event.clientX - box.left) / box.width * (view.to - view.from);
}

/* A wheel zooms about the pointer, a press moves to it, and so does a drag. */
function watchTime(element) {
    element.addEventListener("wheel", (event) => {
        event.preventDefault();
        const s = sUnder(event, element), factor = Math.exp(event.deltaY / 400);
        setView(s - (s - view.from) * factor, s + (view.to - s) * factor);
    }, { passive: false });
    element.addEventListener("pointerdown", (event) => {
        element.setPointerCapture?.(event.pointerId);
        seek(sUnder(event, element));
    });
    element.addEventListener("pointermove", (event) => event.buttons & 1 && seek(sUnder(event, element)));
    element.addEventListener("dblclick", () => setView(0, wholeSpan));
}
