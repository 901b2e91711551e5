/* Measures a large page, many.html: the time in which a browser that already runs opens it and shows
 * scene and table, and how fast the page plays (tools.js). */
"use strict";

async function play() {
    await new Promise((done) => setTimeout(done, 3000)); /* the browser starts */
    const from = performance.now();
    await open("many.html");
    const opened = performance.now() - from, frames = [];
    await press(" ");
    await new Promise((done) => {
        const begin = performance.now();
        const next = (now) => {
            frames.push(now);
            if (now - begin < 10000)
                view.requestAnimationFrame(next);
            else
                done();
        };
        view.requestAnimationFrame(next);
    });
    const times = frames.slice(1).map((now, i) => now - frames[i]).sort((a, b) => a - b);
    Object.assign(found, {
        window: [innerWidth, innerHeight], open_ms: Math.round(opened), steps: view.fmb.steps.length, pairs: view.fmb.rows.length,
        frames_per_s: Math.round(times.length / (frames[frames.length - 1] - frames[0]) * 10000) / 10,
        frame_ms_p50: times[times.length >> 1], frame_ms_p99: times[Math.floor(times.length * 0.99)], moment: text("#moment"),
    });
}

drive([play]);
