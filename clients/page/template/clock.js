/* The time of the log on a line, without its long pauses.
 *
 * Where queries come in bursts with long pauses between them, and would be dots on a true axis,
 * each pause is folded to a short break. Places on the line are in seconds too, but for the
 * breaks. */

const PAUSE_PART = 1 / 20;  /* of the whole: shorter ones are not folded */
const PAUSE_TIMES = 10;     /* the median step: steps as usual are none */
const PAUSES_PART = 0.8;    /* of the whole: where they are less, nothing is folded */
const BREAK_PART = 0.03;    /* of what is left: what a break takes */

function median(numbers) {
    const sorted = numbers.slice().sort((a, b) => a - b);
    return sorted.length ? sorted[sorted.length >> 1] : 0;
}

/* The steps in which nothing was asked for unusually long. */
function findPauses(times) {
    const steps = times.slice(1).map((time, i) => ({ from: times[i], seconds: time - times[i] }));
    const span = times.length ? times[times.length - 1] - times[0] : 0;
    const usual = median(steps.map((step) => step.seconds));
    return steps.filter((step) => step.seconds > span * PAUSE_PART
        && step.seconds > usual * PAUSE_TIMES);
}

/* Those to fold; none where that is not worth it. */
function findFolds(pauses, span) {
    const idle = pauses.reduce((sum, pause) => sum + pause.seconds, 0);
    return idle > PAUSES_PART * span && idle < span ? pauses : [];
}

/* times: ascending. pauses: {from, seconds}; breaks: those that are folded, {from, seconds, place,
 * width}; at: from time to place; time: back. */
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
