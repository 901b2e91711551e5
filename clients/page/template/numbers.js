"use strict";

/* Numbers and times, as people read them. */

const DIGITS = 6;

function clamp(value, low, high) {
    return value > high ? high : value >= low ? value : low;
}

/* With so many digits at most, and no -0. */
function digits(value, count) {
    return String(Number(value.toPrecision(count)) + 0);
}

/* Of a number that JSON has: those it has not are written as words (page_event.h). */
function short(value) {
    return typeof value === "number" ? digits(value, DIGITS) : String(value);
}

/* The shortest text that reads back as the same double. */
function exact(value) {
    return typeof value === "number" ? String(value + 0) : String(value);
}

/* The decimal place of the first digit: 0 for 1 to 9, -1 for 0.1. */
function firstPlace(value) {
    return Math.floor(Math.log10(value));
}

/* The ends of an interval: as many digits as show three of their difference. */
function endDigits(low, high) {
    const difference = high - low, largest = Math.max(Math.abs(low), Math.abs(high));
    if (!Number.isFinite(difference) || largest === 0)
        return DIGITS;
    if (difference > 0)
        return clamp(firstPlace(largest) - firstPlace(difference) + 3, DIGITS, 17);
    return clamp(firstPlace(largest) + 4, DIGITS, 12);
}

/* An end of a box: null is infinite. */
function endText(value, sign, count) {
    if (value === null)
        return sign < 0 ? "-∞" : "∞";
    return typeof value === "number" ? digits(value, count) : String(value);
}

/* "0.25 .. 0.5" */
function intervalText(low, high) {
    const isNumbers = typeof low === "number" && typeof high === "number";
    const count = isNumbers ? endDigits(low, high) : DIGITS;
    return `${endText(low, -1, count)} .. ${endText(high, 1, count)}`;
}

function intervalExact(low, high) {
    return `${low === null ? "-∞" : exact(low)} .. ${high === null ? "∞" : exact(high)}`;
}

/* Of a gap: one number where its bounds look alike. */
function gapText(gap) {
    const texts = gap ? [endText(gap[0], -1, DIGITS), endText(gap[1], 1, DIGITS)] : ["–"];
    return [...new Set(texts)].join(" .. ");
}

/* The texts of two intervals: exact where they would look alike, and are not. */
function intervalTexts(then, now) {
    const texts = [intervalText(...then), intervalText(...now)];
    const alike = texts[0] === texts[1] && (then[0] !== now[0] || then[1] !== now[1]);
    return alike ? [intervalExact(...then), intervalExact(...now)] : texts;
}

function grouped(count) {
    return String(count).replace(/\B(?=(\d{3})+$)/g, ",");
}

function counted(count, one, many) {
    return `${grouped(count)} ${count === 1 ? one : many}`;
}

/* Seconds with three digits behind the point, or as many of the microseconds as there are. */
function timeText(seconds) {
    return seconds.toFixed(6).replace(/0{1,3}$/, "");
}

/* Of a tick of the axis. */
function secondsText(seconds, step) {
    return (seconds + 0).toFixed(clamp(-Math.floor(Math.log10(step) + 1e-9), 0, 6));
}

function durationText(seconds) {
    if (seconds >= 2 * 86400)
        return `${digits(seconds / 86400, 3)} days`;
    if (seconds >= 2 * 3600)
        return `${digits(seconds / 3600, 3)} h`;
    if (seconds >= 120)
        return `${digits(seconds / 60, 3)} min`;
    return `${digits(seconds, 4)} s`;
}

/* Nanoseconds, in a unit of their size. */
function costText(ns) {
    if (ns < 1e4)
        return `${grouped(ns)} ns`;
    return ns < 1e7 ? `${digits(ns / 1e3, 3)} µs` : `${digits(ns / 1e6, 3)} ms`;
}

/* Microseconds since 1970; what no date has, as it is. */
function dateText(utime) {
    const date = new Date(utime / 1000);
    return Number.isNaN(date.getTime())
        ? `${utime} µs` : date.toISOString().replace("T", " ").replace("Z", " UTC");
}

/* 1, 2 or 5 times a power of ten, not below rough. */
function niceStep(rough) {
    const power = 10 ** Math.floor(Math.log10(rough)), times = rough / power;
    return power * (times <= 1 ? 1 : times <= 2 ? 2 : times <= 5 ? 5 : 10);
}

/* Multiples of step, with the digits that it has. */
function tickText(value, step) {
    const size = Math.abs(value);
    if (size !== 0 && (size >= 1e6 || step < 1e-5)) {
        const count = clamp(Math.ceil(Math.log10(size / step)), 0, 15);
        return value.toExponential(count).replace(/(\.\d*?)0+e/, "$1e").replace(/\.?e\+?/, "e");
    }
    return (value + 0).toFixed(clamp(-Math.floor(Math.log10(step) + 1e-9), 0, 9));
}

/* The first index of an ascending list whose value is not below this one. */
function lowerBound(list, value) {
    let low = 0, high = list.length;
    while (low < high) {
        const middle = (low + high) >> 1;
        if (list[middle] < value)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}
