/* Maps the time of the log to a line without long pauses.
 *
 * If queries come in bursts with long pauses between them, the bursts would be dots on a linear
 * axis. Each pause is then folded to a short break. Places on the line are in seconds, except in
 * breaks. */

const PAUSE_PART = 1 / 20;  /* of the whole time: shorter pauses are not folded */
const PAUSE_TIMES = 10;     /* times the median step: shorter steps are not pauses */
const PAUSES_PART = 0.8;    /* of the whole time: if all pauses are shorter, none is folded */
const BREAK_PART = 0.03;    /* of the remaining time: the width of a break */

function median(numbers) {
    const sorted = numbers.slice().sort((a, b) => a - b);
    return sorted.length ? sorted[sorted.length >> 1] : 0;
}

/* The steps without queries that are unusually long. */
function findPauses(times) {
    const steps = times.slice(1).map((time, i) => ({ from: times[i], seconds: time - times[i] }));
    const span = times.length ? times[times.length - 1] - times[0] : 0;
    const usual = median(steps.map((step) => step.seconds));
    return steps.filter((step) => step.seconds > span * PAUSE_PART
        && step.seconds > usual * PAUSE_TIMES);
}

/* The pauses to fold; none if they do not take most of the time. */
function findFolds(pauses, span) {
    const idle = pauses.reduce((sum, pause) => sum + pause.seconds, 0);
    return idle > PAUSES_PART * span && idle < span ? pauses : [];
}

/* times: ascending. Returns pauses: {from, seconds}; breaks: the folded ones, {from, seconds,
 * place, width}; at: converts a time to a place; time: the inverse. */
function makeClock(times) {
    const first = times.length ? times[0] : 0, last = times.length ? times[times.length - 1] : 0;
    const pauses = findPauses(times), folds = findFolds(pauses, last - first);
    const busy = last - first - folds.reduce((sum, pause) => sum + pause.seconds, 0);
    const width = busy * BREAK_PART;
    let saved = 0;
    const breaks = folds.map((pause) => {
        const place = pause.from - first - saved;
        saved += pause.seconds - width;
        return { ...pause, place, width, saved };
    });
    return {
        pauses, breaks, length: last - first - saved,
        at(time) {
            let place = time - first;
            for (const fold of breaks) {
                if (time >= fold.from + fold.seconds)
                    place = time - first - fold.saved;
                else if (time > fold.from)
                    return fold.place + fold.width * (time - fold.from) / fold.seconds;
            }
            return place;
        },
        time(place) {
            let time = place + first;
            for (const fold of breaks) {
                if (place >= fold.place + fold.width)
                    time = place + first + fold.saved;
                else if (place > fold.place)
                    return fold.from + fold.seconds * (place - fold.place) / fold.width;
            }
            return time;
        },
    };
}
