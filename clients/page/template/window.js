/* Contact intervals above the slider, and the tip at the pointer. */

function isMoving(event) {
    return event.T > 0 && stage.drawable.some((frame) => frame.velocity !== null);
}

/* ---- Bands: times of contact ---- */

/* [times now, times then if they differ] */
function timesOfPair(pair) {
    const then = timesOf(pair.then), now = timesOf(pair.now);
    const differs = pair.differs && then && (!now || now[0] !== then[0] || now[1] !== then[1]);
    return [now ?? (pair.differs ? null : then), differs ? then : null];
}

function bandsOf(event) {
    const pair = chosenPair(), bands = [];
    for (const of of pair ? [pair] : stage.pairs.slice(0, BOXES_MAX)) {
        const [now, then] = timesOfPair(of), name = of.ids.map(bodyName).join(" – ");
        if (now)
            bands.push(makeBand(VERDICTS[verdictOf(of.now ?? of.then)], now, event.T,
                `${name}: in contact ${intervalText(...now)} s`));
        if (then)
            bands.push(makeBand("then", then, event.T,
                `${name}: then in contact ${intervalText(...then)} s`));
    }
    return bands;
}

function drawBands() {
    const event = stage.event, moving = isMoving(event);
    find("window").hidden = !moving;
    stopPlaying();
    if (moving)
        show(find("bands"), ...bandsOf(event));
    showMoment();
}

/* ---- Pointer ---- */

function point(at) {
    const index = at ? faces.group[faceBelow(at)] ?? -1 : -1;
    const frame = stage.frames[index];
    showTip(frame ? at : null, frame && `body ${bodyName(frame.id)}, ${shapeName(frame.shape)}: `
        + verdictName(stage.worst[index]));
    if (index !== stage.pointed) {
        stage.pointed = index;
        redrawStage();
    }
}
