/* The data of the page, as page.c writes them, and what follows from them. */

const one = (id) => document.getElementById(id);

/* Unpacks what an element holds, compressed and in base64. Returns it as the body of a response. */
function unpack(id) {
    const text = one(id).textContent, { readable, writable } = new DecompressionStream("deflate"), writer = writable.getWriter();
    one(id).remove();
    writer.write(Uint8Array.fromBase64?.(text) ?? Uint8Array.from(atob(text), (c) => c.charCodeAt(0)));
    writer.close();
    return new Response(readable);
}

if (!globalThis.DecompressionStream)
    one("counts").textContent = "This browser is too old for the page: it has no DecompressionStream.";
const data = await unpack("data").json();
const SEPARATED = 1, TOUCHING = 2, OVERLAPPING = 3;
const verdictNames = ["not decided", "separated", "touching", "overlapping"];
const { steps } = data, isReplay = data.kind === "replay";

/* ---- Scenes and answers as JSON ---- */

/* An answer as the page uses it: {step, frames, verdict, error, contact, box, point, gap}. frames: the pairs of frames in
 * contact, [frame, frame, verdict, first time, last time]; box: lower ends, then upper ends; point: its time, then its
 * position; gap: bounds, then the time of the witness points and these points, if there are any. */
function readAnswer(step, frames, { verdict, error, contact, box, point, gap, witness }) {
    return {
        step, frames, verdict: Math.max(verdictNames.indexOf(verdict), 0), error, contact, box: box && [...box.min, ...box.max],
        point: point && [point.time, ...point.position],
        gap: gap && [...gap, ...witness ? [witness.time, ...witness.a, ...witness.b] : []],
    };
}

const doesMove = ({ velocity, end }) => Boolean(velocity ?? end);

/* The bodies of a step without their poses; one list for all steps with the same bodies. */
const castByKey = new Map();
function castOf({ bodies }) {
    const cast = bodies.map(({ id, name, shape, missing }) => [id, missing ?? shape, name]), key = JSON.stringify(cast);
    return castByKey.get(key) ?? castByKey.set(key, cast).get(key);
}

for (const step of steps) {
    Object.assign(step, { T: step.duration, poses: step.bodies, bodies: castOf(step), moves: step.bodies.some(doesMove) && step.duration > 0 });
    step.pairs = step.pairs.map(({ bodies: [a, b], then, now, frame_contacts: frames, ...answer }) =>
        [a, b, ...(then ? [then, now] : [answer]).map((each) => readAnswer(step, frames, each))]);
}
data.origin = steps[0]?.poses.find(({ position }) => position)?.position ?? [0, 0, 0];
steps.sort((a, b) => a.t - b.t);
/* Scenes without duration are counted. */
const unit = steps.some((step) => step.T > 0) || isReplay ? "s" : "";
if (!unit)
    steps.forEach((step, i) => { step.t = i; });

/* ---- Numbers ---- */

function short(number, digits = 6) {
    return number === null ? "∞" : String(Number(number.toPrecision(digits)));
}

/* An interval, with more digits than `least` if its ends would look equal. */
function interval(low, high, least = 6) {
    if (low === high || low === null || high === null)
        return low === high ? short(low, least) : `${short(low, least)} to ${short(high, least)}`;
    const digits = [least, 9, 12].find((count) => count >= least && low.toPrecision(count) !== high.toPrecision(count)) ?? 17;
    return [low, high].map((number) => short(number, digits)).join(" to ");
}

/* Converts an interval of times in the window of a step to clock times, with six digits of its duration. */
function clockInterval({ t, T }, first, last) {
    const begin = unit ? t : 0, digits = 6 + Math.max(Math.floor(Math.log10(begin / (T || 1))), 0);
    return interval(begin + first, begin + last, Math.min(digits, 15));
}

/* The smallest number, 1, 2 or 5 times a power of ten, that is not below x. */
function roundUp(x) {
    const power = 10 ** Math.floor(Math.log10(x));
    return [1, 2, 5, 10].find((k) => k * power >= x) * power;
}

/* ---- Answers ---- */

const verdictOf = (answer) => answer?.verdict ?? 0;

/* The later answer of a pair [a, b, answer] or [a, b, then, now]; and whether the two differ. */
const nowOf = (pair) => pair[pair.length - 1];
const isDifferent = (pair) => pair.length > 3;
const isNear = (step, answer) => answer.verdict >= TOUCHING
    || Boolean(answer.gap && step.margin && answer.gap[0] <= step.margin);

/* ---- Bodies and rows ---- */

function bodyName(step, index) {
    const [id, , name] = step.bodies[index] ?? [0];
    return name || (id === 0 ? `#${index}` : String(id));
}

/* The key of a body over the steps: its id, or of an anonymous one its index. */
function bodyKey(step, index) {
    const id = step.bodies[index]?.[0];
    return id ? String(id) : `#${index}`;
}

/* A row is a pair over all steps: `at` are the indices of the steps that answer it, in order, and
 * `pairs` these answers. */
const rows = [], rowByKey = new Map();

function addPair(step, i, pair) {
    const names = [bodyName(step, pair[0]), bodyName(step, pair[1])];
    const keys = [bodyKey(step, pair[0]), bodyKey(step, pair[1])];
    if (Number(keys[0]) > Number(keys[1])) {
        keys.reverse();
        names.reverse();
    }
    const key = keys.join("|");
    let row = rowByKey.get(key);
    if (!row) {
        row = { index: rows.length, keys, name: names.join(" – "), at: [], pairs: [], worst: 0, differs: false };
        rowByKey.set(key, row);
        rows.push(row);
    }
    if (row.at[row.at.length - 1] === i)
        return; /* a repeat */
    row.at.push(i);
    row.pairs.push(pair);
    row.worst = Math.max(row.worst, verdictOf(nowOf(pair)));
    row.differs = row.differs || isDifferent(pair);
}

steps.forEach((step, i) => step.pairs.forEach((pair) => addPair(step, i, pair)));

/* The index of the last of ascending numbers that is no larger than x; -1: none. */
function lastUpTo(ascending, x) {
    let low = 0, high = ascending.length;
    while (low < high) {
        const middle = (low + high) >> 1;
        if (ascending[middle] <= x)
            low = middle + 1;
        else
            high = middle;
    }
    return low - 1;
}

/* The keys of the bodies of a step, made once for each list of bodies. */
function keysOf({ bodies }) {
    bodies.keySet ??= new Set(bodies.map((_, index) => bodyKey({ bodies }, index)));
    return bodies.keySet;
}

/* The pair of a row in step i: [a, b, answers...]; null: the step says nothing about it. */
function pairAt(row, i) {
    const mark = lastUpTo(row.at, i);
    if (row.at[mark] === i)
        return row.pairs[mark];
    const step = steps[i];
    return step?.all && row.keys.every((key) => keysOf(step).has(key)) ? [-1, -1, { verdict: SEPARATED }] : null;
}

/* ---- Time: what is shown runs over `s`, which leaves long pauses out ---- */

const times = steps.map((step) => step.t), pauses = times.slice(1).map((t, i) => t - times[i]);
const sorted = pauses.filter((pause) => pause > 0).sort((a, b) => a - b), usualPause = sorted[sorted.length >> 1] ?? 0.02;
const longestPause = isReplay ? Math.max(20 * usualPause, 2) : Infinity;
const begins = [0]; /* [step]: s of its begin, and of the end of all; steps of one time follow each other */
for (const pause of pauses)
    begins.push(begins[begins.length - 1] + Math.min(pause || usualPause / 4, longestPause));
if (steps.length > 0)
    begins.push(begins[steps.length - 1] + (isReplay && steps.length > 1 ? usualPause : unit ? steps[steps.length - 1].T : 1));
const wholeSpan = begins[begins.length - 1] || 1;

/* ---- Streams: queries about other bodies may alternate ---- */

const recent = Math.max(10 * usualPause, 0.1);
const nextLike = new Array(steps.length).fill(-1); /* [step]: the next one of the same bodies */
const lastLike = new Map();
steps.forEach((step, i) => {
    if (lastLike.has(step.bodies))
        nextLike[lastLike.get(step.bodies)] = i;
    lastLike.set(step.bodies, i);
});

/* The steps that hold at step i: itself, and of a replay those of other bodies that are not long ago,
 * and that are queried again soon. */
function streamsOf(i) {
    const streams = [i], casts = new Set([steps[i].bodies]);
    for (let j = i - 1; isReplay && j >= 0 && i - j < 50 && begins[i] - begins[j] <= recent; j--)
        if (!casts.has(steps[j].bodies)) {
            casts.add(steps[j].bodies);
            if (nextLike[j] > i && begins[nextLike[j]] - begins[i] <= recent)
                streams.push(j);
        }
    return streams;
}

/* The pair of a row that holds at step i; undefined: none. */
function pairNow(row, i) {
    return steps[i] && streamsOf(i).map((j) => pairAt(row, j)).find(Boolean);
}

/* The step that is shown at s. */
function stepAt(s) {
    return Math.max(Math.min(lastUpTo(begins, s), steps.length - 1), 0);
}

/* Seconds since the begin of the window of the step. */
function offsetAt(s, i) {
    return steps[i] ? Math.min(Math.max(s - begins[i], 0), steps[i].T) : 0;
}

function timeOf(s) {
    const i = stepAt(s);
    return steps[i] ? Math.min(steps[i].t + (unit ? Math.max(s - begins[i], 0) : 0), steps[i + 1]?.t ?? Infinity) : 0;
}

function sOfTime(t) {
    const i = Math.max(lastUpTo(times, t), 0);
    return steps[i] ? Math.min(begins[i] + Math.max(t - steps[i].t, 0), begins[i + 1]) : 0;
}
