// The page about `chartOf`: map, sliders, the point that was asked for. Bokeh draws.

const COARSE = [140, 90], FINE = [420, 260];
const SETTLED = 120; // milliseconds without a move until the fine grid is evaluated

(() => {
    const data = JSON.parse(document.getElementById("data").textContent);
    const chart = chartOf(data), nameOf = namesOf(data), axes = chart.axes, [x, y] = axes;
    const element = (id) => document.getElementById(id);
    const make = (tag, properties = {}, children = []) => {
        const made = Object.assign(document.createElement(tag), properties);
        made.append(...children);
        return made;
    };
    const shown = (axis, value) => value / axis.per, meant = (axis, value) => value * axis.per;
    const number = (value, digits = 6) => {
        if (!Number.isFinite(value)) return "∞";
        return String(Number(value.toPrecision(digits))).replace("-", "−").replace("e+", "e");
    };
    const rounded = (axis, value) => Number(shown(axis, value).toPrecision(7));

    // ---- sliders

    const further = axes.slice(2).map((axis) => {
        const at = Math.floor((axis.count - 1) / 2);
        const input = make("input", {
            type: "range", min: 0, max: axis.count - 1, step: 1, value: at, name: axis.name,
        });
        const value = () => axis.low + (axis.high - axis.low) * input.valueAsNumber / (axis.count - 1);
        const output = make("output");
        const tell = () => {
            output.value = number(shown(axis, value()), 5);
            input.setAttribute("aria-valuetext", output.value);
        };
        input.addEventListener("input", () => { tell(); changed(); });
        tell();
        element("sliders").append(make("label", {}, [make("span", {textContent: axis.label}), input, output]));
        return value;
    });
    element("sliders").addEventListener("submit", (event) => event.preventDefault());
    const values = () => further.map((value) => value());

    // ---- the map

    const P = Bokeh.Plotting, {ndarray} = Bokeh.require("core/util/ndarray");
    const range = (axis) => new Bokeh.Range1d({
        start: shown(axis, axis.low), end: shown(axis, axis.high),
        bounds: [shown(axis, axis.low), shown(axis, axis.high)],
    });
    const map = P.figure({
        x_range: range(x), y_range: range(y),
        tools: "pan,box_zoom,wheel_zoom,reset,save", toolbar_location: "above",
        sizing_mode: "stretch_both", min_height: 300,
    });
    map.xaxis.axis_label = x.label;
    map.yaxis.axis_label = y.label;
    map.toolbar.logo = null;
    // a finger moves the page
    map.toolbar.active_drag = matchMedia("(pointer: coarse)").matches ? null :
        map.toolbar.tools.find((tool) => tool instanceof Bokeh.BoxZoomTool);
    const image = new Bokeh.ColumnDataSource({data: {T: [], kind: [], x: [], y: [], w: [], h: []}});
    const heat = new Bokeh.LogColorMapper({
        low: data.colours[0], high: data.colours[1], nan_color: "rgba(0, 0, 0, 0)", palette: palette(false),
    });
    const kinds = new Bokeh.LinearColorMapper({low: UNDECIDED - 0.5, high: BEYOND_FLOAT + 0.5, palette: KINDS(false), nan_color: "rgba(0, 0, 0, 0)"});
    const place = {x: {field: "x"}, y: {field: "y"}, dw: {field: "w"}, dh: {field: "h"}, source: image};
    map.image({image: {field: "T"}, color_mapper: heat, ...place});
    map.image({image: {field: "kind"}, color_mapper: kinds, ...place});
    const bar = new Bokeh.ColorBar({color_mapper: heat, width: 12, padding: 4});
    map.add_layout(bar, "right");
    const DASHES = {"+1": [6, 2], "-1": [], pair: [6, 2, 1, 2]};
    const edges = data.tongues.map((tongue) => {
        const Omega = x.name === "Omega" ? x : y, other = Omega === x ? y : x;
        const along = [tongue.lower, tongue.upper].map((e) => e.map((v) => shown(Omega, v)));
        const across = tongue.y.map((v) => shown(other, v));
        return along.map((edge) => map.line({
            x: Omega === x ? edge : across, y: Omega === x ? across : edge,
            line_width: 1, line_dash: DASHES[tongue.kind],
        }));
    }).flat();
    const picked = new Bokeh.ColumnDataSource({data: {x: [], y: []}});
    const mark = map.scatter({
        x: {field: "x"}, y: {field: "y"}, source: picked, marker: "circle_cross", size: 14,
        fill_color: null, line_width: 1.5,
    });

    let later = null, window_of = null;
    function draw([nx, ny]) {
        const [x0, x1] = [map.x_range.start, map.x_range.end], [y0, y1] = [map.y_range.start, map.y_range.end];
        const points = (axis, from, to, count) => Float64Array.from({length: count}, (_, k) =>
            Math.min(Math.max(meant(axis, from + (to - from) * (k + 0.5) / count), axis.low), axis.high));
        const xs = points(x, x0, x1, nx), ys = points(y, y0, y1, ny);
        const {T, state} = chart.onGrid(chart.section(values()), xs, ys);
        const table = (value) => ndarray(
            Float64Array.from(state, value).buffer, {dtype: "float64", shape: [ny, nx]});
        const heats = table((s, k) => (s === UNSTABLE ? Math.max(T[k], data.colours[0]) : NaN));
        const others = table((s) => (s >= UNDECIDED ? s : NaN));
        image.data = {T: [heats], kind: [others], x: [x0], y: [y0], w: [x1 - x0], h: [y1 - y0]};
        const count = (s) => state.reduce((sum, v) => sum + (v === s), 0) / state.length;
        const unstable = count(UNSTABLE) + count(BEYOND_FLOAT), open = count(UNDECIDED) + count(NO_EQUATION);
        const share = (v) => `${(100 * v).toFixed(v < 0.001 && v > 0 ? 3 : 1)} %`;
        element("share").textContent = `${share(unstable)} of the map is unstable, ${share(open)} undecided.`;
        window_of = {nx, ny, state, T};
    }
    function changed() {
        draw(COARSE);
        ask();
        clearTimeout(later);
        later = setTimeout(() => draw(FINE), SETTLED);
    }
    map.on_event("rangesupdate", () => {
        clearTimeout(later);
        later = setTimeout(() => draw(FINE), SETTLED);
    });

    // ---- a point

    const given = [x, y].map((axis) => {
        const input = make("input", {
            type: "number", step: "any", name: axis.name, value: rounded(axis, 0.5 * (axis.low + axis.high)),
            min: shown(axis, axis.low), max: shown(axis, axis.high),
        });
        input.addEventListener("change", ask);
        element("place").append(make("label", {}, [axis.label, input]));
        return input;
    });
    let hertz = null;
    if (!data.time) {
        hertz = make("input", {type: "number", step: "any", min: 0, name: "hertz", placeholder: "optional"});
        hertz.addEventListener("change", ask);
        element("place").append(make("label", {}, ["unit of Ω in Hz", hertz]));
    }
    element("place").addEventListener("submit", (event) => { event.preventDefault(); ask(); });
    const clamp = (axis, value) => Math.min(Math.max(value, axis.low), axis.high);
    const asked = () => given.map((input, k) => {
        const axis = axes[k], typed = input.valueAsNumber;
        // what is typed is rounded: an end of the axis is meant by it
        return clamp(axis, meant(axis, Number.isFinite(typed) ? typed : shown(axis, axis.low)));
    });
    const words = (point, found) => {
        const name = nameOf(point, found);
        return name === null ? null : name.tongue || name.nearest;
    };

    function facts(point, found) {
        const told = [
            ["verdict", found.verdict, found.verdict],
            ["T", !found.known ? "not evaluated here: P has no series" : found.state === NO_EQUATION ? "no equation here" : found.state === BEYOND_FLOAT ?
                "beyond a float" : `${number(found.T)} ± ${number(found.T_error, 1)}`],
        ];
        const name = nameOf(point, found);
        if (name !== null) told.push(name.tongue ? ["tongue", name.tongue] : ["resonance", `nearest: ${name.nearest}`]);
        if (Number.isFinite(found.T)) {
            const one = {s: "second"}[data.time] || data.time || "unit of time";
            const exponent = 0.5 * found.T, f = hertz ? hertz.valueAsNumber : NaN;
            const grows = (rate, unit) => {
                const units = unit === "unit of time" ? "units of time" : `${unit}s`;
                const factor = number(100 * Math.expm1(rate), 4);
                told.push(["growth", `${factor} % per ${unit}, exponent ${number(rate, 4)}`]);
                if (rate > 0 && found.state === UNSTABLE) {
                    told.push(["doubles in", `${number(Math.LN2 / rate, 4)} ${units}`]);
                }
            };
            grows(exponent, one);
            if (f > 0) grows(exponent * 2 * Math.PI * f, "second");
        }
        if (found.nearby) {
            const at = found.nearby.map((v, k) => `${axes[k].label} ${number(shown(axes[k], v))}`);
            told.push(["evaluated at", `${at.join(", ")}: no series is good here`]);
        }
        return told;
    }

    function ask() {
        const point = [...asked(), ...values()], found = chart.at(point);
        element("told").replaceChildren(...facts(point, found).flatMap(([term, text, look]) =>
            [make("dt", {textContent: term}), make("dd", {textContent: text, className: look || ""})]));
        picked.data = {x: [shown(x, point[0])], y: [shown(y, point[1])]};
        const mu = [...found.mu].sort((a, b) => Math.hypot(...b) - Math.hypot(...a));
        element("multipliers").tBodies[0].replaceChildren(...mu.map(([re, im]) => make("tr", {}, [
            make("td", {textContent: number(Math.hypot(re, im), 8)}),
            make("td", {textContent: number(Math.atan2(im, re) * 180 / Math.PI, 6)}),
        ])));
        roots_of.data = {x: mu.map((m) => m[0]), y: mu.map((m) => m[1])};
        const reach = 1.15 * Math.max(1.1, ...mu.map((m) => Math.max(Math.abs(m[0]), Math.abs(m[1]))));
        circle.x_range.setv({start: -reach, end: reach});
        circle.y_range.setv({start: -reach, end: reach});
        return found;
    }

    // ---- multipliers

    const circle = P.figure({
        x_range: new Bokeh.Range1d({start: -1.3, end: 1.3}), y_range: new Bokeh.Range1d({start: -1.3, end: 1.3}),
        tools: "", toolbar_location: null, frame_width: 205, frame_height: 205,
    });
    circle.toolbar.logo = null;
    circle.xaxis.axis_label = "Re μ";
    circle.yaxis.axis_label = "Im μ";
    const turns = Array.from({length: 181}, (_, k) => 2 * Math.PI * k / 180);
    const unit = circle.line({x: turns.map(Math.cos), y: turns.map(Math.sin), line_width: 1.2});
    const roots_of = new Bokeh.ColumnDataSource({data: {x: [], y: []}});
    const dots = circle.scatter({x: {field: "x"}, y: {field: "y"}, source: roots_of, size: 9, marker: "circle"});

    // ---- hover and click

    const bubble = make("div", {id: "bubble", hidden: true});
    bubble.setAttribute("aria-hidden", "true"); // what it says is said of the point that is asked for
    element("map").append(bubble);
    const there = (event) => [meant(x, event.x), meant(y, event.y)];
    const on_map = ([u, v]) => u >= x.low && u <= x.high && v >= y.low && v <= y.high;
    map.on_event("mousemove", (event) => {
        const point = there(event);
        bubble.hidden = !on_map(point);
        if (bubble.hidden) return;
        const all = [...point, ...values()], found = chart.at(all), name = words(all, found);
        const T = !found.known ? "not evaluated" : found.state === NO_EQUATION ? "no equation" : `T = ${number(found.T, 5)}`;
        bubble.replaceChildren(
            make("b", {textContent: found.verdict, className: found.verdict}), make("br"),
            T, ...(name ? [make("br"), name] : []), make("br"),
            `${x.label} ${number(shown(x, point[0]), 5)}, ${y.label} ${number(shown(y, point[1]), 5)}`);
        const box = element("map").getBoundingClientRect();
        const left = event.sx + 16, wide = bubble.offsetWidth;
        bubble.style.left = `${left + wide > box.width ? event.sx - wide - 16 : left}px`;
        bubble.style.top = `${Math.max(event.sy - bubble.offsetHeight - 8, 0)}px`;
    });
    map.on_event("mouseleave", () => { bubble.hidden = true; });
    map.on_event("tap", (event) => {
        const point = there(event);
        if (!on_map(point)) return;
        given.forEach((input, k) => { input.value = rounded(axes[k], point[k]); });
        ask();
    });

    // ---- light and dark

    function palette(dark) {
        const own = [...Bokeh.Palettes.viridis(256)];
        return dark ? own : own.reverse();
    }
    function KINDS(dark) {
        return dark ? ["#8a8f96", "#f5a623", "#ff5c5c"] : ["#8c8c8c", "#ff7f0e", "#d62728"];
    }
    const scheme = matchMedia("(prefers-color-scheme: dark)");
    function paint() {
        const dark = scheme.matches, style = getComputedStyle(document.documentElement);
        const colour = (name) => style.getPropertyValue(name).trim();
        const ink = colour("--ink"), line = colour("--line"), paper = colour("--paper");
        for (const figure of [map, circle]) {
            figure.setv({
                background_fill_color: paper, border_fill_color: figure === map ? paper : colour("--panel"),
                outline_line_color: line,
            });
            for (const axis of [...figure.xaxes, ...figure.yaxes]) {
                axis.setv({
                    axis_label_text_color: ink, major_label_text_color: ink, axis_line_color: ink,
                    major_tick_line_color: ink, minor_tick_line_color: line,
                    axis_label_text_font_style: "normal", axis_label_text_font_size: "14px",
                    major_label_text_font_size: "12px",
                });
            }
            for (const grid of [...figure.xgrids, ...figure.ygrids]) grid.grid_line_color = line;
            for (const grid of [...figure.xgrids, ...figure.ygrids]) grid.grid_line_alpha = 0.4;
        }
        bar.setv({
            background_fill_color: paper, major_label_text_color: ink, title_text_color: ink,
            major_tick_line_color: ink, bar_line_color: line,
        });
        heat.palette = palette(dark);
        kinds.palette = KINDS(dark);
        for (const edge of edges) edge.glyph.line_color = dark ? "#ffffff" : "#000000";
        mark.glyph.line_color = dark ? "#ffffff" : "#c2185b";
        unit.glyph.line_color = ink;
        dots.glyph.setv({fill_color: colour("--accent"), line_color: ink});
        const square = (background, text) => make("li", {}, [
            Object.assign(make("i"), {style: `background: ${background}`}), text]);
        const [open, none, beyond] = KINDS(dark);
        const rule = (kind, text) => make("li", {}, [
            Object.assign(make("i", {className: "rule"}), {style: `--rule: ${kind}`}), text]);
        const lines = {"-1": ["solid", "edge, μ = −1"], "+1": ["dashed", "edge, μ = 1"], pair: ["dotted", "edge, a pair of μ"]};
        const crossings = new Set(data.tongues.map((tongue) => tongue.kind));
        element("legend").replaceChildren(
            square(paper, "stable"), square("linear-gradient(90deg, #fde725, #21918c, #440154)", "unstable: the colour is T"), square(open, "undecided"),
            square(none, "no equation"), square(beyond, "growth beyond a float"),
            ...Object.entries(lines).filter(([kind]) => crossings.has(kind)).map(([, own]) => rule(...own)));
    }
    scheme.addEventListener("change", paint);

    paint();
    Promise.all([P.show(map, element("map")), P.show(circle, element("circle"))]).then(() => {
        draw(FINE);
        ask();
        document.body.dataset.ready = "true";
    });
    // for those who open the console
    window.explorer = {data, chart, nameOf, map, ask, values, window: () => window_of};
})();
