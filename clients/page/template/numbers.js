"use strict";

/* Formats numbers and times for people. */

const DIGITS = 6;

function clamp(value, low, high) {
    return value > high ? high : value >= low ? value : low;
}

/* With at most so many significant digits, and without -0. */
function digits(value, count) {
    return String(Number(value.toPrecision(count)) + 0);
}

/* A short form of a number. Values that JSON lacks are words (page_event.h). */
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

/* The number of digits for the ends of an interval: enough to show three digits of their
 * difference. */
function endDigits(low, high) {
    const difference = high - low, largest = Math.max(Math.abs(low), Math.abs(high));
    if (!Number.isFinite(difference) || largest === 0)
        return DIGITS;
    if (difference > 0)
        return clamp(firstPlace(largest) - firstPlace(difference) + 3, DIGITS, 17);
    return clamp(firstPlace(largest) + 4, DIGITS, 12);
}

/* An end of a box; null is infinite. */
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

/* The bounds of a gap, as one number if both are the same text. */
function gapText(gap) {
    const texts = gap ? [endText(gap[0], -1, DIGITS), endText(gap[1], 1, DIGITS)] : ["–"];
    return [...new Set(texts)].join(" .. ");
}

/* The texts of two intervals, with exact numbers if they differ and their short texts would not. */
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

/* Seconds with three decimals, or more if microseconds require it. */
function timeText(seconds) {
    return seconds.toFixed(6).replace(/0{1,3}$/, "");
}

/* The label of a tick on the time axis. */
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

/* Formats nanoseconds in a suitable unit. */
function costText(ns) {
    if (ns < 1e4)
        return `${grouped(ns)} ns`;
    return ns < 1e7 ? `${digits(ns / 1e3, 3)} µs` : `${digits(ns / 1e6, 3)} ms`;
}

/* Formats microseconds since 1970 as a date; times beyond the range of dates as a number. */
function dateText(utime) {
    const date = new Date(utime / 1000);
    return Number.isNaN(date.getTime())
        ? `${utime} µs` : date.toISOString().replace("T", " ").replace("Z", " UTC");
}

/* The smallest 1, 2 or 5 times a power of ten that is not below rough. */
function niceStep(rough) {
    const power = 10 ** Math.floor(Math.log10(rough)), times = rough / power;
    return power * (times <= 1 ? 1 : times <= 2 ? 2 : times <= 5 ? 5 : 10);
}

/* Formats a multiple of step with the decimals of step. */
function tickText(value, step) {
    const size = Math.abs(value);
    if (size !== 0 && (size >= 1e6 || step < 1e-5)) {
        const count = clamp(Math.ceil(Math.log10(size / step)), 0, 15);
        return value.toExponential(count).replace(/(\.\d*?)0+e/, "$1e").replace(/\.?e\+?/, "e");
    }
    return (value + 0).toFixed(clamp(-Math.floor(Math.log10(step) + 1e-9), 0, 9));
}

/* The index of the first element of an ascending list that is not below value. */
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
