// The player of a run's page. The page has the drawings as JSON: clips of shapes that keep their look, each a few instants
// between which every number moves uniformly. Links may end in #t=2.5 or #t=2.5&play.
"use strict";
const run = JSON.parse(document.getElementById("run").textContent);
const part = id => document.getElementById(id);
const pictures = [...document.querySelectorAll("svg.moving")];
const eventButtons = [...document.querySelectorAll("button[data-t]")];
const eventTimes = eventButtons.map(button => Number(button.dataset.t));
const speeds = [0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5].map(factor => Number((factor * run.speed).toPrecision(1)));

// ---- the data: numbers of moving shapes are stored as differences from instant to instant

for (const clip of run.clips)
    for (const entry of clip.shapes)
        if (Array.isArray(entry) && !Array.isArray(entry[1][0])) {
            const width = entry[1].length / clip.t.length;
            for (let i = width; i < entry[1].length; ++i) entry[1][i] += entry[1][i - width];
        }

// The index of the last number of a sorted list that is at most x; 0 if all are larger.
function lastUpTo(list, x, of = each => each) {
    let low = 0, high = list.length;
    while (high - low > 1) {
        const middle = (low + high) >> 1;
        if (of(list[middle]) <= x) low = middle; else high = middle;
    }
    return low;
}

// ---- shapes as elements of SVG

function made(name, look) {
    const element = document.createElementNS("http://www.w3.org/2000/svg", name);
    element.setAttribute("class", look);
    return element;
}

function outline(numbers, counts, closed) {
    let text = "", next = 0;
    for (const count of counts) {
        for (let i = 0; i < count; ++i, next += 2) text += `${i ? "L" : "M"}${numbers[next]} ${numbers[next + 1]}`;
        if (closed && count) text += "Z";
    }
    return text;
}

function place(shape, element, numbers, counts = shape.counts) {
    if (shape.kind === "circle") {
        ["cx", "cy", "r"].forEach((name, i) => element.setAttribute(name, numbers[i]));
    } else if (shape.kind === "text") {
        ["x", "y"].forEach((name, i) => element.setAttribute(name, numbers[i]));
    } else {
        element.setAttribute("d", outline(numbers, counts, shape.closed));
    }
}

const elements = run.shapes.map(shape => {
    const element = made(shape.kind, shape.look);
    if (shape.kind === "text") element.textContent = shape.text;
    if (shape.numbers) place(shape, element, shape.numbers);
    return element;
});
const trail = run.trail.map(line => {
    const future = made("path", line.future), past = made("path", line.past);
    future.setAttribute("d", outline(line.numbers, [line.t.length], false));
    return {line, future, past};
});

// ---- the run at one time

let time = run.start, shownClip = null, shownEvent = -1;

// The shapes of a clip in the pictures; the trail lies below the first shape that moves.
function show(clip) {
    shownClip = clip;
    pictures.forEach((picture, p) => {
        const ids = clip.shapes.map(entry => Array.isArray(entry) ? entry[0] : entry).filter(id => run.shapes[id].in === p);
        const first = ids.findIndex(id => run.shapes[id].moves);
        const below = p === run.world ? [...trail.map(each => each.future), ...trail.map(each => each.past)] : [];
        const list = ids.map(id => elements[id]);
        list.splice(first < 0 ? list.length : first, 0, ...below);
        picture.replaceChildren(...list);
    });
    part("phase").textContent = clip.phase;
    part("phase").className = clip.look;
}

function draw() {
    const clip = run.clips[lastUpTo(run.clips, time, each => each.t[0])];
    if (clip !== shownClip) show(clip);
    const i = lastUpTo(clip.t, time), last = i + 1 === clip.t.length;
    const share = last ? 0 : Math.min((time - clip.t[i]) / (clip.t[i + 1] - clip.t[i]), 1);
    for (const entry of clip.shapes) {
        if (!Array.isArray(entry)) continue;
        const [id, numbers] = entry, shape = run.shapes[id];
        if (Array.isArray(numbers[0])) {
            place(shape, elements[id], numbers[i][1], numbers[i][0]);
            continue;
        }
        const width = numbers.length / clip.t.length, from = i * width, to = last ? from : from + width;
        const now = [];
        for (let k = 0; k < width; ++k) now.push(Math.round(10 * (numbers[from + k] + share * (numbers[to + k] - numbers[from + k]))) / 10);
        place(shape, elements[id], now);
    }
    for (const {line, past} of trail) {
        const count = line.t[0] > time ? 0 : lastUpTo(line.t, time) + 1;
        past.setAttribute("d", outline(line.numbers, [count], false));
    }
    const fraction = (time - run.start) / (run.end - run.start || 1);
    part("slider").value = String(Math.round(1e6 * fraction));
    part("slider").setAttribute("aria-valuetext", part("clock").textContent = `t = ${time.toFixed(run.digits)} s`);
    const current = eventTimes.length && eventTimes[0] <= time ? lastUpTo(eventTimes, time) : -1;
    if (current !== shownEvent) {
        eventButtons[shownEvent]?.removeAttribute("aria-current");
        eventButtons[current]?.setAttribute("aria-current", "true");
        shownEvent = current;
    }
}

function seek(t) {
    time = Math.min(Math.max(t, run.start), run.end);
    draw();
}

// ---- playing

let before = null;
const isPlaying = () => before !== null;

function step(now) {
    if (!isPlaying()) return;
    // A browser stops drawing a hidden tab; the run then continues from the time shown last.
    const passed = Math.min(Math.max(now - before, 0), 250) / 1000 * Number(part("speed").value);
    before = now;
    seek(time + passed);
    if (time >= run.end) pause(); else requestAnimationFrame(step);
}

function pause() {
    before = null;
    part("play").textContent = "\u25B6\uFE0E";
    part("play").setAttribute("aria-label", "Play");
}

function play() {
    if (time >= run.end) seek(run.start);
    before = performance.now();
    part("play").textContent = "\u275A\u275A";
    part("play").setAttribute("aria-label", "Pause");
    requestAnimationFrame(step);
}

const toggle = () => isPlaying() ? pause() : play();

// ---- the user

for (const speed of speeds) part("speed").add(new Option(`${speed}\u00D7`, String(speed), false, speed === run.speed));
part("play").addEventListener("click", toggle);
part("slider").addEventListener("input", () => seek(run.start + part("slider").value / 1e6 * (run.end - run.start)));
eventButtons.forEach((button, k) => button.addEventListener("click", click => {
    seek(eventTimes[k]);
    if (click.detail > 0) button.blur();  // after a click of the mouse, Space plays
}));

function toEvent(direction) {
    const others = eventTimes.filter(t => direction > 0 ? t > time : t < time);
    if (others.length) seek(direction > 0 ? others[0] : others[others.length - 1]);
}

const keys = {
    " ": toggle, "Home": () => seek(run.start), "End": () => seek(run.end), ".": () => toEvent(1), ",": () => toEvent(-1),
    "ArrowRight": () => seek(time + 0.05 * run.speed), "ArrowLeft": () => seek(time - 0.05 * run.speed),
};
document.addEventListener("keydown", event => {
    const isOfControl = event.target.closest("select, summary, button") && event.key !== "." && event.key !== ",";
    if (isOfControl || event.ctrlKey || event.altKey || event.metaKey || !(event.key in keys)) return;
    event.preventDefault();
    keys[event.key]();
});

// Texts keep their size on the screen.
const fit = () => pictures.forEach(picture =>
    picture.style.setProperty("--px", picture.viewBox.baseVal.width / (picture.clientWidth || picture.viewBox.baseVal.width)));
addEventListener("resize", fit);
fit();

function follow() {
    const wanted = new URLSearchParams(location.hash.slice(1));
    const t = Number(wanted.get("t") ?? NaN);
    seek(Number.isFinite(t) ? t : time);
    if (wanted.has("play") && !isPlaying()) play();
}
addEventListener("hashchange", follow);
pause();
follow();
