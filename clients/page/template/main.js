/* Puts the page together. */

function showHead() {
    const count = (verdict) => rows.filter((row) => row.worst === verdict).length;
    const counts = [OVERLAPPING, TOUCHING, SEPARATED].map((verdict) => `${count(verdict)} ${verdictNames[verdict]}`);
    one("title").textContent = document.title = isReplay ? `${data.title}, ${data.sides[1]}, compared with ${data.sides[0]}` : data.title;
    one("counts").textContent = [
        steps.length > 1 ? `${steps.length} ${isReplay ? "queries" : "scenes"}` : "",
        `${rows.length} pairs: ${counts.join(", ")}`,
        isReplay ? `${differences.length} different` : "",
    ].filter(Boolean).join(" · ");
    one("counts").classList.toggle("different", differences.length > 0);
    const notes = [...data.notes, ...steps.some((step) => step.more) ? ["Pairs of large steps are left out; the step says how many."] : []];
    one("notes").textContent = notes.join(" · ");
    one("notes").classList.toggle("warn", notes.some((note) => note.includes("left out")));
}

const keys = {
    " ": () => play(), ArrowLeft: () => move(-1), ArrowRight: () => move(1), Home: () => seek(0), End: () => seek(wholeSpan),
    n: () => nextContact(), N: () => nextContact(-1), d: () => nextDifference(), D: () => nextDifference(-1),
    l: () => one("loop").click(), "+": () => setSpeed(1), "-": () => setSpeed(-1), f: () => fit(), c: () => fit(stage.row),
    1: () => fit(null, directions.iso), 2: () => fit(null, directions.top), 3: () => fit(null, directions.front), 4: () => fit(null, directions.side),
    0: () => setView(0, wholeSpan), "/": () => one("filter").focus(), Escape: () => stage.row && choose(stage.row),
    ArrowDown: () => chooseNext(1), ArrowUp: () => chooseNext(-1),
};

function setSpeed(by) {
    one("speed").selectedIndex = Math.min(Math.max(one("speed").selectedIndex + by, 0), one("speed").length - 1);
}

function chooseNext(by) {
    const at = table.shown.indexOf(stage.row) + by;
    if (table.shown[at])
        choose(table.shown[at]);
}

function readHash(url) {
    const found = /#t=(-?[0-9.]+(e[+-]?[0-9]+)?)$/.exec(url);
    if (found && Number.isFinite(Number(found[1])))
        seek(sOfTime(Number(found[1])));
}

function watch() {
    document.addEventListener("click", ({ target }) => {
        const tr = target.closest("#pairs tr");
        if (target.dataset.key)
            keys[target.dataset.key]();
        else if (tr && !target.closest(".lane"))
            choose(rows[tr.dataset.row]);
    });
    one("more").addEventListener("click", () => {
        table.limit += 100;
        chooseRows();
    });
    one("pairs").addEventListener("pointerdown", (event) => {
        const lane = event.target.closest(".lane");
        if (lane)
            seek(sUnder(event, lane.firstChild));
    });
    one("filter").addEventListener("input", chooseRows);
    one("contacts").addEventListener("change", chooseRows);
    one("colour").addEventListener("change", show);
    one("names").addEventListener("change", () => { stage.dirty = true; });
    one("scrub").addEventListener("input", () => seek(Number(one("scrub").value)));
    for (const id of ["overview", "gap-plot"])
        watchTime(one(id));
    document.addEventListener("keydown", (event) => {
        const isTyping = event.target.matches?.("input[type=search], select") || (event.target.id === "scrub" && event.key.startsWith("Arrow"));
        if (isTyping || event.ctrlKey || event.metaKey || event.altKey || !keys[event.key])
            return;
        event.preventDefault();
        keys[event.key]();
    });
    addEventListener("hashchange", (event) => readHash(event.newURL));
    addEventListener("resize", drawTime);
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => {
        readColours();
        drawTime();
    });
}

function start() {
    one("scrub").max = wholeSpan;
    one("time").hidden = !canPlay;
    one("next-difference").hidden = differences.length === 0;
    readColours();
    showHead();
    drawHeads();
    chooseRows();
    watch();
    drawOverview();
    if (rows.length > 0)
        choose(table.shown[0]);
    show();
    readHash(location.href);
    requestAnimationFrame(tick);
}

start();

/* For the console of a browser, and for tests. */
globalThis.fmb = { data, steps, rows, stage, player, pace, table, view, begins, camera, drawScene, followPace, hitAt, placed, seek };
