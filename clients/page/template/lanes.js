/* Verdicts and gaps over time. */

const view = { from: 0, to: wholeSpan, width: 0 }; /* the shown part, in s, and its width in pixels */

/* What a row's mark shows: [from, to, verdict] in s, in order. The verdict lasts until the next step of the same
 * bodies, if this comes soon. Where windows do not overlap, the pair is separated before and after the contact. */
function spansOf(row, mark) {
    const i = row.at[mark], step = steps[i], from = begins[i], like = begins[nextLike[i]] ?? Infinity;
    const to = isReplay && like - from <= recent ? like : begins[i + 1];
    const answer = nowOf(row.pairs[mark]), verdict = verdictOf(answer);
    if (verdict < TOUCHING || !answer.contact || step.T === 0 || to - from < 0.999 * step.T)
        return [[from, to, verdict]];
    const [first, last] = answer.contact.map((time) => Math.min(from + time, to));
    return [[from, first, SEPARATED], [first, last, verdict], [last, to, SEPARATED]].filter(([begin, end, each]) => each === verdict || begin < end);
}

/* The row as [from, to, verdict], in order; what follows with the same verdict is one. */
function segmentsOf(row) {
    if (row.segments)
        return row.segments;
    const segments = [];
    row.at.flatMap((_, mark) => spansOf(row, mark)).forEach(([from, to, verdict]) => {
        const before = segments[segments.length - 1];
        if (before && before[2] === verdict && from - before[1] <= 1e-9 * wholeSpan)
            before[1] = Math.max(to, before[1]);
        else
            segments.push([from, to, verdict]);
    });
    row.segments = segments;
    return segments;
}

/* The times in s at which a pair comes into contact, ascending. */
let contactBegins = null;
function contacts() {
    contactBegins ??= [...new Set(rows.flatMap((row) => segmentsOf(row)
        .filter(([, , verdict], k, all) => verdict >= TOUCHING && !(k > 0 && all[k - 1][2] >= TOUCHING && all[k - 1][1] >= all[k][0] - 1e-9 * wholeSpan))
        .map(([from]) => from)))].sort((a, b) => a - b);
    return contactBegins;
}

const differences = steps.flatMap((step, i) => step.differs || step.pairs.some(isDifferent) ? [i] : []);

const sizeOf = ({ clientWidth: width, clientHeight: height }) => ({ width, height });

/* A canvas of the size that it has on the page; null: it has none. */
function fitCanvas(canvas, { width, height } = sizeOf(canvas)) {
    const ratio = Math.min(devicePixelRatio, 2);
    if (width === 0 || height === 0)
        return null;
    canvas.width = width * ratio;
    canvas.height = height * ratio;
    const to = canvas.getContext("2d", { willReadFrequently: true }); /* a hundred on the GPU would be slow */
    to.scale(ratio, ratio);
    return { to, width, height, x: (s) => (s - view.from) / (view.to - view.from) * width };
}

const namesContacts = steps.some((step) => step.all); /* other pairs are separated */

/* Draws rows into one lane: in each column of pixels the strongest verdict. */
function drawLane(canvas, some, size = sizeOf(canvas)) {
    const fitted = fitCanvas(canvas, size);
    if (!fitted)
        return;
    const { to, width, x } = fitted, height = Math.min(fitted.height, 18), worst = new Uint8Array(Math.ceil(width) + 1);
    if (some.length === 1 && namesContacts)
        worst.fill(SEPARATED);
    for (const row of some) {
        for (const [from, until, verdict] of segmentsOf(row)) {
            if (until < view.from || from > view.to)
                continue;
            const last = Math.min(Math.max(Math.ceil(x(until)), Math.floor(x(from)) + 2), worst.length);
            for (let column = Math.max(Math.floor(x(from)), 0); column < last; column++)
                worst[column] = Math.max(worst[column], verdict);
        }
    }
    for (let column = 0, first = 0; column <= width; column++) {
        if (column < width && worst[column] === worst[first])
            continue;
        if (worst[first] > 0) {
            to.fillStyle = stage.colours[verdictNames[worst[first]]];
            to.fillRect(first, worst[first] === SEPARATED ? height / 2 - 1 : 2, column - first, worst[first] === SEPARATED ? 2 : height - 4);
        }
        first = column;
    }
    to.fillStyle = stage.colours.diff;
    for (const i of some.length === 1 ? some[0].at.filter((_, mark) => isDifferent(some[0].pairs[mark])) : differences)
        to.fillRect(Math.round(x(begins[i])) - 1, 0, 3, height);
}

/* Draws ticks at round times, below the height y. */
function drawTicks(to, width, y) {
    const span = view.to - view.from, every = Math.max(roundUp(span / (width / 90)), unit ? 0 : 1);
    to.font = "11px system-ui, sans-serif";
    to.fillStyle = stage.colours.ink;
    let free = -Infinity;
    const first = Math.ceil(timeOf(view.from) / every), last = timeOf(view.to);
    for (let k = first; k * every <= last && k < first + 1e4; k++) {
        const s = sOfTime(k * every), i = stepAt(s), x = (s - view.from) / span * width;
        if (k * every - timeOf(s) > every / 2) { /* within a pause that is left out */
            k = Math.max(k, Math.ceil(steps[i + 1]?.t / every) - 1);
            continue;
        }
        const text = `${short(k * every)}${unit && ` ${unit}`}`, size = to.measureText(text).width;
        if (x < free || x + size > width)
            continue;
        to.fillText(text, x + 3, y + 13);
        to.fillRect(x, y, 1, 16);
        free = x + size + 8;
    }
}

/* Draws all verdicts, the time axis below them, and the pauses that are left out. */
function drawOverview() {
    drawLane(one("overview"), rows);
    const canvas = one("overview"), to = canvas.getContext("2d"), width = view.width = canvas.clientWidth;
    if (width === 0)
        return;
    drawTicks(to, width, 18);
    to.fillStyle = stage.colours.dim;
    pauses.forEach((pause, i) => {
        if (pause > longestPause)
            to.fillRect((begins[i + 1] - view.from) / (view.to - view.from) * width - 2, 0, 3, 34);
    });
}

/* ---- The gap of the chosen pair ---- */

/* [[s, gap, end], ...] of a row: the gap holds from s to end. then: take the first of two answers. */
function gapsOf(row, then = false) {
    return row.at.flatMap((i, mark) => {
        const gap = (then ? row.pairs[mark][2] : nowOf(row.pairs[mark])).gap;
        return gap && gap[0] !== null ? [[begins[i], gap[0], spansOf(row, mark).pop()[1]]] : [];
    });
}

function drawGap(row) {
    const gaps = row ? gapsOf(row) : [];
    one("gap").hidden = gaps.length < 2;
    const fitted = gaps.length > 1 && fitCanvas(one("gap-plot"));
    if (!fitted)
        return;
    const { to, width, height, x } = fitted, margin = steps[row.at[0]].margin ?? 0;
    const low = Math.min(0, ...gaps.map(([, gap]) => gap)), high = Math.max(margin, ...gaps.map(([, gap]) => gap)) || 1;
    const y = (gap) => height - 24 - (gap - low) / (high - low || 1) * (height - 36);
    const line = (points, colour, dash = []) => {
        to.strokeStyle = colour;
        to.setLineDash(dash);
        to.lineWidth = dash.length ? 1 : 1.6;
        to.beginPath();
        /* the line is broken where a gap ends before the next one begins */
        points.forEach(([s, gap], k) => to[k === 0 || s - points[k - 1][2] > 1e-9 * wholeSpan ? "moveTo" : "lineTo"](x(s), y(gap)));
        to.stroke();
    };
    drawTicks(to, width, height - 16);
    to.fillStyle = stage.colours.ink;
    [0, margin, high, low].forEach((level, k, all) => {
        to.strokeStyle = stage.colours.rule;
        to.setLineDash(k === 1 ? [4, 4] : []);
        to.strokeRect(0, y(level), k < 2 ? width : 6, 0);
        if (all.slice(0, k).every((other) => Math.abs(y(other) - y(level)) >= 12))
            to.fillText(short(level, 3), 8, y(level) + 4);
    });
    if (row.differs)
        line(gapsOf(row, true), stage.colours.diff, [5, 3]);
    line(gaps, stage.colours.gap);
    gaps.forEach(([s, gap]) => {
        to.fillStyle = stage.colours.gap;
        if (gaps.length < 200)
            to.fillRect(x(s) - 1.5, y(gap) - 1.5, 3, 3);
    });
    one("gap-said").textContent = `gap of ${row.name}: ${interval(Math.min(...gaps.map(([, gap]) => gap)), Math.max(...gaps.map(([, gap]) => gap)))
    }, in the scene's unit of length, over time${margin ? "; dashed: the margin" : ""}${row.differs ? `; dashed in colour: ${data.sides[0]}` : ""}`;
}
