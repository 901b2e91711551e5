/* The data of the page, and values derived once: sorted events, and rows of pairs. */

const data = JSON.parse(document.getElementById("data").textContent);

/* enum replay_outcome. */
const SAME = 0, DIFFERENT = 1, BUSY = 2, UNKNOWN = 3, UNDEFINED = 4, UNRECORDED = 5;
const OUTCOMES = ["same", "different", "busy", "unknown body", "not defined", "without result"];
const OUTCOME_TEXT = [
    "The result is the one that was recorded.",
    "The result is another one than the one that was recorded.",
    "The service was busy then: there is no answer to compare.",
    "The service did not hold a body then: there is no answer to compare.",
    "The log does not define the handle of a body: there is no answer to compare.",
    "No result was recorded: there is nothing to compare.",
];

const CUBOID = 1, FACE = 3, BOX = 4;
const WANT_BOX = 1, WANT_CERTIFICATE = 2, WANT_TIMES = 4, WANT_GAP = 8;
const KIND_PAIR = 0, KIND_LISTED = 1, KIND_ALL = 2, KIND_ACROSS = 3;

/* ---- Events ---- */

/* Sorted by time, stable. Raw events get two members: at, the index in this list, and seconds since
 * the log began. */
const events = data.events.slice().sort((a, b) => Number(a.t) - Number(b.t));
events.forEach((event, at) => {
    event.at = at;
    event.seconds = (Number(event.t) - Number(data.begin)) / 1e6;
});

const differing = events.filter((event) => event.is === DIFFERENT);

/* The verdict of one side of a pair, then or now (page_event.h). */
function verdictOf(side) {
    return side === null ? NO_VERDICT : typeof side === "number" ? side : side[0];
}

/* [first, last], or null. */
function timesOf(side) {
    return Array.isArray(side) && side[1] !== null ? [side[1], side[2]] : null;
}

/* [lower bound, upper bound, time of the least distance..., witness points...], or null. */
function gapOf(side) {
    const last = Array.isArray(side) ? side[side.length - 1] : null;
    return Array.isArray(last) ? last : null;
}

/* [lower ends, upper ends], or null. */
function boxOf(side) {
    const end = Array.isArray(side) ? side.length - (gapOf(side) ? 1 : 0) : 0;
    if (end <= 3)
        return null;
    const dim = (end - 3) / 2;
    return [side.slice(3, 3 + dim), side.slice(3 + dim, end)];
}

function bodyOf(event, index) {
    return index < event.frames.length ? String(event.frames[index][0]) : "?";
}

function bodyName(id) {
    return id === "0" ? "anonymous" : id;
}

/* The pairs of an event: bodies, then and now. The outcome of the replay decides whether anything
 * differs: with a tolerance it may accept different bits. */
function pairsOf(event) {
    return event.pairs.map(([a, b, then, now], index) => {
        const given = now !== undefined;
        return {
            index, a, b, then, now: given ? now : then, ids: [bodyOf(event, a), bodyOf(event, b)],
            differs: given && event.is === DIFFERENT && then !== null && now !== null,
        };
    });
}

/* The result to show: the new one, or the recorded one if there is none. null: neither. */
function answerOf(event) {
    return [event.now, event.then].find((result) => result && result.status === 0) ?? null;
}

/* Worst first. */
function worstOf(event) {
    let worst = NO_VERDICT;
    for (const [, , then, now] of event.pairs)
        worst = Math.max(worst, verdictOf(now ?? then));
    const answer = answerOf(event);
    if (worst < SEPARATED && answer && answer.count && answer.count[SEPARATED] > 0)
        worst = SEPARATED;
    return worst;
}

/* R(q) of fmb.h as rows, for an orientation that need not be normalised; null: not rotated. */
function rotationOf(orientation) {
    if (orientation.length === 0)
        return null;
    const largest = Math.max(...orientation.map(Math.abs));
    const q = orientation.map((value) => value / largest), norm = q.reduce((s, x) => s + x * x, 0);
    const [w, x, y, z] = q.length === 2 ? [q[0], 0, 0, q[1]] : q;
    return [[w * w + x * x - y * y - z * z, 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), w * w - x * x + y * y - z * z, 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), w * w - x * x - y * y + z * z]]
        .map((row) => row.map((value) => value / norm));
}

/* A box as a cuboid: [shape, origin..., components...]. */
function cuboidOf(dim, [shape, ...numbers]) {
    if (shape !== BOX)
        return [shape, ...numbers];
    const size = numbers.slice(dim), components = [];
    for (let i = 0; i < dim * dim; i++)
        components.push(i % (dim + 1) === 0 ? size[i / (dim + 1)] : 0);
    return [CUBOID, ...size.map((value, axis) => numbers[axis] - value / 2), ...components];
}

/* For each placed body: its shape, position, rotation (null: none) and velocity (null: none); or
 * the reason why it cannot be drawn. */
function framesOf(event) {
    return event.frames.map(([id, shape, ...numbers], index) => {
        const frame = { index, id: String(id), shape: null, why: "" };
        if (shape === -1)
            frame.why = `the log does not define its handle, ${numbers[0]}`;
        else if (shape === -2)
            frame.why = "it is no body that can be drawn";
        if (shape < 0)
            return frame;
        frame.shape = data.shapes[shape];
        frame.position = numbers[0];
        frame.orientation = numbers[1];
        frame.rotation = rotationOf(numbers[1]);
        frame.velocity = numbers[2].length > 0 ? numbers[2] : null;
        return frame;
    });
}

/* ---- Rows: the pairs of bodies ---- */

function isBelow(a, b) {
    const difference = Number(a) - Number(b);
    return difference < 0 || (difference === 0 && a < b);
}

function rowKey(ids) {
    return isBelow(ids[0], ids[1]) ? `${ids[0]} ${ids[1]}` : `${ids[1]} ${ids[0]}`;
}

/* at: indices of events; verdict: of each; differs: the events among them that differ */
function makeRow(key) {
    return {
        key, ids: key.split(" "), at: [], verdict: [], differs: [], contacts: 0, filled: false,
    };
}

function addMark(row, at, verdict, differs) {
    const last = row.at.length - 1;
    if (row.at[last] === at) { /* several placements with the same bodies */
        row.verdict[last] = Math.max(row.verdict[last], verdict);
    } else {
        row.at.push(at);
        row.verdict.push(verdict);
    }
    if (differs && row.differs[row.differs.length - 1] !== at)
        row.differs.push(at);
    row.contacts += verdict >= TOUCHING ? 1 : 0;
}

function addToRow(rows, ids, event, verdict, differs) {
    const key = rowKey(ids), row = rows.get(key) ?? makeRow(key);
    rows.set(key, row);
    addMark(row, event.at, verdict, differs);
}

/* Adds an event to the rows of its pairs. An event that differs as a whole, in no pair, differs in
 * all its rows. */
function addEvent(rows, event) {
    const pairs = pairsOf(event);
    const whole = event.is === DIFFERENT && !pairs.some((pair) => pair.differs);
    for (const pair of pairs)
        addToRow(rows, pair.ids, event, verdictOf(pair.now ?? pair.then), pair.differs || whole);
    if (event.kind === KIND_PAIR && pairs.length === 0) /* the query was refused */
        addToRow(rows, [bodyOf(event, 0), bodyOf(event, 1)], event, NO_VERDICT, whole);
}

function rowRank(row) {
    return row.differs.length > 0 ? 0 : row.contacts > 0 ? 1 : 2;
}

function compareRows(a, b) {
    const rank = rowRank(a) - rowRank(b);
    if (rank !== 0 || a.key === b.key)
        return rank;
    const first = a.ids[0] === b.ids[0] ? 1 : 0;
    return isBelow(a.ids[first], b.ids[first]) ? -1 : 1;
}

/* Rows with differences first, then rows with contacts. */
function makeRows() {
    const rows = new Map();
    events.forEach((event) => addEvent(rows, event));
    return [...rows.values()].sort(compareRows);
}

const rows = makeRows();
const rowOf = new Map(rows.map((row) => [row.key, row]));

/* The row of all queries. */
function makeAllRow() {
    const row = { ...makeRow("all"), filled: true };
    for (const event of events)
        addMark(row, event.at, worstOf(event), event.is === DIFFERENT);
    return row;
}

const allRow = makeAllRow();

/* The number of a pair of placements in a query of all or across. */
function pairNumber(event, a, b) {
    const n = event.frames.length;
    return event.kind === KIND_ACROSS
        ? a * (n - event.split) + b - event.split : a * n - a * (a + 1) / 2 + b - (a + 1);
}

/* In a query of all or across, a pair that the result does not name is separated, if the result
 * reaches it. */
function isSeparated(event, ids) {
    const answer = answerOf(event);
    if (event.kind < KIND_ALL || !answer || event.more)
        return false;
    event.places = event.places
        ?? new Map(event.frames.map((frame, index) => [String(frame[0]), index]).reverse());
    let [a, b] = ids.map((id) => event.places.get(id));
    if (a === undefined || b === undefined || a === b)
        return false;
    [a, b] = a < b ? [a, b] : [b, a];
    if (event.kind === KIND_ACROSS && (a >= event.split || b < event.split))
        return false;
    const number = pairNumber(event, a, b);
    return number >= event.first && number < answer.end;
}

/* Adds the events in which the pair is separated without being named. Called for rows that are
 * shown. */
function fillRow(row) {
    if (row.filled)
        return row;
    const named = new Map(row.at.map((at, index) => [at, row.verdict[index]]));
    row.at = [];
    row.verdict = [];
    for (const event of events) {
        if (!named.has(event.at) && !isSeparated(event, row.ids))
            continue;
        row.at.push(event.at);
        row.verdict.push(named.get(event.at) ?? SEPARATED);
    }
    row.filled = true;
    return row;
}

/* ---- Differences as text ---- */

function boxTexts(then, now) {
    const axes = [];
    for (let axis = 0; axis < then[0].length; axis++) {
        const ends = [then, now].map((box) => [box[0][axis], box[1][axis]]);
        if (ends[0][0] !== ends[1][0] || ends[0][1] !== ends[1][1])
            axes.push([`box ${"xyz"[axis]}`, ...intervalTexts(ends[0], ends[1])]);
    }
    return axes;
}

/* [what, then, now] for each difference of the two sides. */
function sideDifferences(then, now) {
    const found = [], verdicts = [verdictOf(then), verdictOf(now)];
    if (verdicts[0] !== verdicts[1])
        found.push(["verdict", verdictName(verdicts[0]), verdictName(verdicts[1])]);
    const gaps = [gapOf(then), gapOf(now)];
    if (JSON.stringify(gaps[0]) !== JSON.stringify(gaps[1]))
        found.push(["gap", ...(gaps[0] && gaps[1] ? intervalTexts(...gaps) : gaps.map(gapText))]);
    if (Math.min(...verdicts) < TOUCHING) /* neither has an interval or a box to compare */
        return found;
    const times = [timesOf(then), timesOf(now)], boxes = [boxOf(then), boxOf(now)];
    if (times[0] && times[1]) {
        if (times[0][0] !== times[1][0] || times[0][1] !== times[1][1])
            found.push(["interval, s", ...intervalTexts(times[0], times[1])]);
    } else if (times[0] || times[1]) {
        found.push(["interval, s", ...times.map((of) => of ? intervalText(...of) : "none")]);
    }
    if (boxes[0] && boxes[1] && boxes[0][0].length === boxes[1][0].length)
        found.push(...boxTexts(boxes[0], boxes[1]));
    else if (boxes[0] || boxes[1])
        found.push(["box", boxes[0] ? "one" : "none", boxes[1] ? "one" : "none"]);
    return found;
}

function statusText(result) {
    return !result ? "no result" : result.status === 0 ? "ok" : result.says;
}

/* As sideDifferences(), for what belongs to the event and not to a pair. */
function wholeDifferences(event) {
    const found = [], { then, now } = event;
    if (event.is !== DIFFERENT)
        return found;
    if (statusText(then) !== statusText(now))
        found.push(["status", statusText(then), statusText(now)]);
    if (then && now && then.method !== now.method && then.status === 0 && now.status === 0)
        found.push(["method", then.method, now.method]);
    if (then && now && then.end !== now.end)
        found.push(["answered up to pair", grouped(then.end), grouped(now.end)]);
    if (event.certificate)
        found.push(["certificate", "another one", "another one"]);
    return found;
}
