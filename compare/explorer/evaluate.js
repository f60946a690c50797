"use strict";
// P from its Chebyshev series, and from P its roots, T and the verdict: the same formulas as the
// chart's own (compare.stability, hill.stability), one polynomial at a time. Nothing here draws.

const STABLE = 0, UNSTABLE = 1, UNDECIDED = 2, NO_EQUATION = 3, BEYOND_FLOAT = 4;
const VERDICTS = ["stable", "unstable", "undecided", "undecided", "unstable"];
const EPS = 2 ** -52;

/** The modulus of x + i y; Math.hypot is twenty times as slow. */
function modulus(x, y) {
    const square = x * x + y * y;
    return square > 1e-280 && square < 1e280 ? Math.sqrt(square) : Math.hypot(x, y);
}

// ---- roots ----------------------------------------------------------------------------------

/** ln |z + sqrt(z^2 - 1)|, the larger, of z = x + i y; x, y >= 0: as hill.stability.log_R. */
function logR(x, y) {
    const plus = x + 1, minus = Math.abs(1 - x);
    const far = modulus(plus, y), rest = modulus(minus, y) + minus;
    const lift = y === 0 ? 0 : y * (y / (far + plus) + y / rest);
    const above = 0.5 * (lift + (plus + minus - 2));
    if (above >= 1e150) return Math.LN2 + Math.log(above);
    return Math.log1p(above + Math.sqrt(above * (above + 2)));
}

/** The real root of z^3 + a z^2 + b z + c that is farthest from the other two. */
function mostIsolated(a, b, c) {
    const third = a / 3, p = b - a * third, q = c + third * (2 * third * third - b);
    const half = 0.5 * Math.abs(q), cube = (p / 3) ** 3, square = half * half + cube;
    let t;
    if (square > 0) {
        const u = Math.cbrt(half + Math.sqrt(square));
        t = u - p / (3 * (u === 0 ? 1 : u));
    } else {
        const radius = Math.sqrt(Math.max(-p / 3, 0));
        const share = half / Math.sqrt(Math.max(-cube, 1e-300));
        t = 2 * radius * Math.cos(Math.acos(Math.min(share, 1)) / 3);
    }
    let z = (q < 0 || Object.is(q, -0) ? t : -t) - third;
    for (let k = 0; k < 2; k++) { // Newton: the closed form loses digits where its terms cancel
        const slope = (3 * z + 2 * a) * z + b;
        if (slope !== 0) z -= (((z + a) * z + b) * z + c) / slope;
    }
    return z;
}

function quadratic(b, c, re, im, at) {
    const x = -0.5 * b, square = x * x - c, root = Math.sqrt(Math.abs(square));
    if (square < 0) {
        re[at] = re[at + 1] = x;
        im[at] = root;
        im[at + 1] = -root;
    } else {
        // the larger by the sum, the other from the product: neither cancels
        const large = x < 0 ? x - root : x + root;
        re[at] = large;
        re[at + 1] = large === 0 ? 0 : c / large;
        im[at] = im[at + 1] = 0;
    }
}

const MOST_ROUNDS = 200;

/** Roots of a monic polynomial into re and im; whether they have settled. By Aberth from degree 4. */
function roots(p, re, im) {
    const n = p.length - 1;
    if (n === 1) { re[0] = -p[1]; im[0] = 0; return true; }
    // the closed forms have third powers
    if (p.some((c) => Math.abs(c) > 1e50)) return aberth(p, n, re, im);
    if (n === 2) { quadratic(p[1], p[2], re, im, 0); return true; }
    if (n === 3) {
        const lone = mostIsolated(p[1], p[2], p[3]), b = p[1] + lone;
        re[0] = lone; im[0] = 0;
        quadratic(b, p[2] + lone * b, re, im, 1);
        return true;
    }
    return aberth(p, n, re, im);
}

const FEW_ROUNDS = 40;

function aberth(p, n, re, im) {
    // from the roots of the polynomial before, next to this one on a grid; off the real line, which
    // no step would leave
    let known = re[0] !== 0 || im[0] !== 0;
    for (let j = 0; j < n; j++) {
        im[j] += 1e-4 * (1 + j) * (j % 2 ? -1 : 1);
        if (!Number.isFinite(re[j]) || !Number.isFinite(im[j])) known = false;
    }
    let settled = known && iterate(p, n, re, im, FEW_ROUNDS);
    if (!settled) {
        start(p, n, re, im);
        settled = iterate(p, n, re, im, MOST_ROUNDS);
    }
    // P is real: what is left of an imaginary part there is rounding; `radii` measures what it costs
    for (let j = 0; j < n; j++) {
        if (Math.abs(im[j]) <= 64 * EPS * (1 + Math.abs(re[j]))) im[j] = 0;
    }
    return settled;
}

/** On circles of the radii that the upper hull of (k, ln |p_k|) has (Bini). */
function start(p, n, re, im) {
    const logs = Array.from(p, (c) => Math.log(Math.abs(c))), hull = [];
    for (let k = 0; k <= n; k++) {
        if (logs[k] === -Infinity) continue;
        while (hull.length > 1) {
            const [i, j] = hull.slice(-2);
            if ((logs[j] - logs[i]) * (k - i) > (logs[k] - logs[i]) * (j - i)) break;
            hull.pop();
        }
        hull.push(k);
    }
    let count = 0;
    for (let h = 1; h < hull.length; h++) {
        const i = hull[h - 1], j = hull[h], radius = Math.exp((logs[j] - logs[i]) / (j - i));
        for (let k = 0; k < j - i; k++, count++) {
            const angle = 2 * Math.PI * k / (j - i) + 2 * Math.PI * h / n + 0.7;
            re[count] = radius * Math.cos(angle);
            im[count] = radius * Math.sin(angle);
        }
    }
    for (; count < n; count++) re[count] = im[count] = 0; // as many last coefficients are 0
}

function iterate(p, n, re, im, rounds) {
    const done = new Uint8Array(n);
    let open = n;
    for (let round = 0; round < rounds && open; round++) {
        for (let j = 0; j < n; j++) {
            if (done[j]) continue;
            const x = re[j], y = im[j], size = modulus(x, y);
            let vr = 1, vi = 0, dr = 0, di = 0, sum = 1;
            for (let k = 1; k <= n; k++) {
                const d = dr * x - di * y + vr, v = vr * x - vi * y + p[k];
                di = dr * y + di * x + vi;
                dr = d;
                vi = vr * y + vi * x;
                vr = v;
                sum = sum * size + Math.abs(p[k]);
            }
            // a value that is all rounding says no more
            if (modulus(vr, vi) <= 2 * n * EPS * sum) { done[j] = 1; open--; continue; }
            // v / (v' - v sum 1/(z_j - z_k))
            let sr = 0, si = 0;
            for (let k = 0; k < n; k++) {
                if (k === j) continue;
                const ex = x - re[k], ey = y - im[k], d = ex * ex + ey * ey;
                if (d > 0) { sr += ex / d; si -= ey / d; }
            }
            const br = dr - (vr * sr - vi * si), bi = di - (vr * si + vi * sr);
            const over = br * br + bi * bi;
            if (over === 0) { re[j] += 1e-3 * (1 + size); continue; }
            const tr = (vr * br + vi * bi) / over, ti = (vi * br - vr * bi) / over;
            re[j] -= tr;
            im[j] -= ti;
            if (modulus(tr, ti) <= EPS * size) { done[j] = 1; open--; }
        }
    }
    return open === 0;
}

/** By descending real part, then ascending imaginary. */
function sorted(re, im) {
    const order = Array.from(re, (_, k) => k).sort((i, j) => re[j] - re[i] || im[i] - im[j]);
    const of = (x) => Float64Array.from(order, (k) => x[k]);
    return [of(re), of(im)];
}

// ---- discs ----------------------------------------------------------------------------------

const RADII = Array.from({length: 115}, (_, k) => 2 ** (-54 + 0.5 * k));

function product(re, im, n) {
    const pr = new Float64Array(n + 1), pi = new Float64Array(n + 1);
    pr[0] = 1;
    for (let j = 0; j < n; j++) {
        for (let k = j + 1; k > 0; k--) {
            const r = pr[k - 1], i = pi[k - 1];
            pr[k] -= re[j] * r - im[j] * i;
            pi[k] -= re[j] * i + im[j] * r;
        }
    }
    return [pr, pi];
}

/** A radius about each root that holds a true one (Rouche): as hill.stability.root_radii. */
function radii(p, error, re, im, size) {
    const n = p.length - 1, moduli = Float64Array.from(re, (x, j) => modulus(x, im[j]));
    const [ar, ai] = product(re, im, n);
    const [mr] = product(moduli.map((m) => -m), new Float64Array(n), n);
    const unsure = new Float64Array(n + 1);
    let largest = 0;
    for (let k = 1; k <= n; k++) {
        unsure[k] = error + modulus(p[k] - ar[k], ai[k]) + 4 * n * EPS * Math.abs(mr[k]);
        largest = Math.max(largest, Math.abs(p[k]) + error);
    }
    return moduli.map((own, j) => {
        const whole = 1 + largest + size[j];
        for (const unit of RADII) {
            const r = unit * size[j], farthest = own + r;
            let value = 1, moved = 0;
            for (let k = 0; k < n; k++) {
                const d = modulus(re[j] - re[k], im[j] - im[k]);
                value *= Math.max(Math.abs(d - r) - 4 * EPS * (size[j] + size[k]), 0);
            }
            for (let k = 0; k <= n; k++) moved = moved * farthest + unsure[k];
            if (value > 1.01 * moved) return Math.min(r, whole);
        }
        return whole;
    });
}

// ---- P of z ---------------------------------------------------------------------------------

/** Whether P's signs alone show all z inside the edges, or one beyond: 1, -1; 0 where neither. */
function bySigns(p, error, between, decay) {
    const n = p.length - 1, c = decay > 0 ? Math.cosh(decay) : 1;
    let inside = true, beyond = false, before = Infinity;
    for (let j = 0; j <= n; j++) {
        const x = j === 0 ? c : j === n ? -c : between[j - 1], size = Math.abs(x);
        if (!(x < before)) inside = false;
        before = x;
        let value = 0, moduli = 0, unsure = 0;
        for (let k = 0; k <= n; k++) {
            value = value * x + p[k];
            moduli = moduli * size + Math.abs(p[k]);
            unsure = unsure * size + (k ? error : 0);
        }
        const margin = 1.01 * unsure + 4 * (n + 1) * (2 + Math.abs(decay)) * EPS * moduli;
        const sign = Math.abs(value) > margin ? Math.sign(value) : 0;
        const expected = j % 2 ? -1 : 1;
        if (sign !== expected) inside = false;
        if (sign === -expected && (j === 0 || j === n)) beyond = true;
    }
    return inside ? 1 : beyond ? -1 : 0;
}

/** Points between the roots, descending: where P' is zero; from the roots from degree 4. */
function separators(p, re) {
    const n = p.length - 1;
    if (n === 1) return [];
    if (n === 2) return [-0.5 * p[1]];
    if (n === 3) {
        const spread = Math.sqrt(Math.max(p[1] * p[1] - 3 * p[2], 0));
        return [(-p[1] + spread) / 3, (-p[1] - spread) / 3];
    }
    const x = Float64Array.from(re).sort().reverse();
    return Array.from(x.subarray(1), (right, k) => 0.5 * (x[k] + right));
}

/** More than the error of ln R can be for roots near [-1, 1]. */
function largestError(n, error) {
    const beyond = 4 * (error + 3 * n * EPS * 2 ** n);
    return Math.sqrt(2 * (beyond * (2 ** n - 1)) ** (1 / n));
}

const inZ = {
    /** T and the verdict, for many points. */
    quick(p, error, Omega, eta, re, im) {
        const n = p.length - 1, settled = roots(p, re, im), decay = Math.PI * eta / Omega;
        let growth = 0, largest = 1;
        for (let j = 0; j < n; j++) growth = Math.max(growth, logR(Math.abs(re[j]), Math.abs(im[j])));
        for (let k = 1; k <= n; k++) largest = Math.max(largest, Math.abs(p[k]));
        const shown = bySigns(p, error, separators(p, re), decay);
        if (shown === 1 && eta === 0) growth = 0;
        const T = Omega / Math.PI * growth - eta, excess = growth - decay;
        if (shown === 1 && eta >= 0) return [T, STABLE];
        if (shown === -1) return [T, UNSTABLE];
        const rounding = 8 * EPS * (1 + Math.abs(decay) + Math.abs(excess));
        const near = settled && largest <= 4 * 2 ** n;
        if (near && excess > largestError(n, error) + rounding) return [T, UNSTABLE];
        return [T, inZ.solve(p, error, Omega, eta).state];
    },

    /** Roots, multipliers, T with a bound on its error, the verdict: as compare.stability.points. */
    solve(p, error, Omega, eta) {
        const n = p.length - 1;
        let re = new Float64Array(n), im = new Float64Array(n);
        roots(p, re, im);
        [re, im] = sorted(re, im);
        const between = Array.from(re.subarray(1), (right, k) => 0.5 * (re[k] + right));
        const decay = Math.PI * eta / Omega, shown = bySigns(p, error, between, decay);
        const size = Float64Array.from(re, (x, j) => 1 + modulus(x, im[j]));
        const radius = radii(p, error, re, im, size);
        let outer = 0, inner = 0, R = 0;
        for (let j = 0; j < n; j++) {
            let real = im[j] === 0;
            for (let k = 0; k < n && real; k++) {
                if (k !== j && !(modulus(re[j] - re[k], im[j] - im[k]) > radius[j])) real = false;
            }
            const x = Math.abs(re[j]), y = Math.abs(im[j]), r = radius[j];
            outer = Math.max(outer, logR(x + r, real ? 0 : y + r));
            inner = Math.max(inner, logR(Math.max(x - r, 0), real ? 0 : Math.max(y - r, 0)));
            R = Math.max(R, logR(x, real ? 0 : y));
        }
        const toT = Omega / Math.PI, rounding = 8 * EPS * (toT + Math.abs(eta));
        const high = toT * outer * (1 + 8 * EPS) - eta + rounding;
        const low = toT * inner * (1 - 8 * EPS) - eta - rounding;
        let T = Math.min(Math.max(toT * R - eta, low), high);
        const stable = high < 0 || (shown === 1 && eta >= 0);
        const unstable = (low > 0 || shown === -1) && !stable;
        const still = shown === 1 && eta === 0;
        if (still) T = 0;
        const T_error = still ? rounding : Math.max(high - T, T - low);
        const over = Math.exp(-decay), mu = [];
        for (const sign of [1, -1]) {
            for (let j = 0; j < n; j++) {
                // sqrt(z - 1) sqrt(z + 1)
                const [ar, ai] = root(re[j] - 1, im[j]), [br, bi] = root(re[j] + 1, im[j]);
                const r = ar * br - ai * bi, i = ar * bi + ai * br;
                mu.push([over * (re[j] + sign * r), over * (im[j] + sign * i)]);
            }
        }
        const z = Array.from(re, (x, j) => [x, im[j]]);
        return {T, T_error, state: stable ? STABLE : unstable ? UNSTABLE : UNDECIDED, z, mu};
    },

    /** What crosses: the root that grows most, as compare.stability.indicators has the kinds. */
    crossing(found) {
        const [x, y] = found.z.reduce((a, b) => (grows(b) > grows(a) ? b : a));
        return y !== 0 && grows([x, y]) > 0 ? "pair" : x > 0 ? "+1" : "-1";
    },
};

function grows([x, y]) {
    return logR(Math.abs(x), Math.abs(y));
}

/** Square root of x + i y, its real part not negative. */
function root(x, y) {
    const size = modulus(x, y), half = Math.sqrt(0.5 * (size + Math.abs(x)));
    if (half === 0) return [0, 0];
    const other = 0.5 * Math.abs(y) / half;
    return x >= 0 ? [half, y < 0 ? -other : other] : [other, y < 0 ? -half : half];
}

// ---- P of the multipliers -------------------------------------------------------------------

const TINY = 1e-300;

const inMu = {
    quick(p, error, Omega, eta, re, im) {
        const n = p.length - 1;
        roots(p, re, im);
        let largest = TINY;
        for (let j = 0; j < n; j++) largest = Math.max(largest, modulus(re[j], im[j]));
        return [Omega / Math.PI * Math.log(largest), inMu.state(p, error, re, im)];
    },

    solve(p, error, Omega) {
        const n = p.length - 1, re = new Float64Array(n), im = new Float64Array(n);
        roots(p, re, im);
        const mu = Array.from(re, (x, j) => [x, im[j]]);
        mu.sort((a, b) => modulus(...b) - modulus(...a));
        const largest = Math.max(modulus(...mu[0]), TINY), T = Omega / Math.PI * Math.log(largest);
        const [low, high] = inMu.largest(p, error, re, im).map((m) => Omega / Math.PI * Math.log(m));
        const rounding = 8 * EPS * (Omega / Math.PI + Math.abs(T));
        const T_error = Math.max(Math.abs(high - T), Math.abs(T - low)) + rounding;
        return {T, T_error, state: inMu.state(p, error, re, im), z: [], mu};
    },

    /** As many beyond the unit circle as seem to be (Rouche); else signs, else discs. */
    state(p, error, re, im) {
        const n = p.length - 1, [ar, ai] = product(re, im, n);
        const moduli = Float64Array.from(re, (x, j) => modulus(x, im[j]));
        const [mr] = product(moduli.map((m) => -m), new Float64Array(n), n);
        let apart = 0, whole = 0, sum = 0, at1 = 0, atMinus1 = 0, gap = 1, beyond = false;
        for (let k = 0; k <= n; k++) {
            apart = Math.max(apart, modulus(p[k] - ar[k], ai[k]));
            whole = Math.max(whole, Math.abs(mr[k]));
            sum += Math.abs(p[k]);
            at1 += p[k];
            atMinus1 += k % 2 ? -p[k] : p[k];
        }
        for (const m of moduli) {
            gap *= Math.max(Math.abs(1 - m) - 4 * EPS * (1 + m), 0);
            if (m > 1) beyond = true;
        }
        const off = error + apart + 4 * EPS * n * whole;
        if (gap > (1 + 8 * n * EPS) * n * off) return beyond ? UNSTABLE : STABLE;
        const margin = error * n + 2 * n * EPS * sum;
        if (at1 < -margin || (n % 2 ? -atMinus1 : atMinus1) < -margin) return UNSTABLE;
        const [low, high] = inMu.largest(p, error, re, im);
        return high < 1 ? STABLE : low > 1 ? UNSTABLE : UNDECIDED;
    },

    /** Between which the largest modulus is. */
    largest(p, error, re, im) {
        const n = p.length - 1;
        const size = Float64Array.from(re, (x, j) => Math.max(modulus(x, im[j]), TINY));
        const radius = radii(p, error, re, im, size);
        let low = 0, high = 0;
        size.forEach((s, j) => {
            low = Math.max(low, s - radius[j]);
            high = Math.max(high, s + radius[j]);
        });
        const mean = Math.max((1 - EPS) * Math.abs(p[n]) - error, 0);
        low = Math.max(low * (1 - 4 * EPS), (1 - 4 * EPS) * mean ** (1 / n));
        return [low, high * (1 + 4 * EPS)];
    },

    crossing(found) {
        const [x, y] = found.mu[0];
        return y !== 0 ? "pair" : x > 0 ? "+1" : "-1";
    },
};

// ---- the chart ------------------------------------------------------------------------------

function floats(text) {
    const bytes = Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
    // little-endian in the file, whatever the machine
    const view = new DataView(bytes.buffer), found = new Float64Array(bytes.length / 8);
    for (let k = 0; k < found.length; k++) found[k] = view.getFloat64(8 * k, true);
    return found;
}

function basis(x, count, into) {
    into[0] = 1;
    if (count > 1) into[1] = x;
    for (let k = 2; k < count; k++) into[k] = 2 * x * into[k - 1] - into[k - 2];
    return into;
}

/** Everything that a page asks of its chart. `data` is what compare.explorer.data makes. */
function chartOf(data) {
    const axes = data.axes, degree = data.degree, reading = data.variable === "z" ? inZ : inMu;
    const pieces = data.pieces.map((piece) => ({...piece, series: floats(piece.series)}));
    const alone = {P: floats(data.alone.P), error: floats(data.alone.error), at: new Map()};
    floats(data.alone.at).forEach((place, i) => alone.at.set(place, i));
    const forcing = axes.findIndex((axis) => axis.name === "Omega");
    // the variable of one axis then moves with another's
    const skew = forcing >= 0 && axes.some((axis) => axis.smooth === "ratio");
    const smooth = (k, value, Omega = data.forcing.Omega) => {
        if (axes[k].smooth === "value") return value;
        return (axes[k].smooth === "ratio" ? Omega : 1) / value;
    };
    const p = new Float64Array(degree + 1);
    const re = new Float64Array(degree), im = new Float64Array(degree);
    p[0] = 1;

    const local = (piece, k, s) => {
        const x = (2 * s - piece.low[k] - piece.high[k]) / (piece.high[k] - piece.low[k]);
        return Math.min(Math.max(x, -1), 1);
    };
    const within = (piece, k, s) => s >= piece.low[k] && s <= piece.high[k];
    const pointAt = (k, index) => {
        const {low, high, count} = axes[k];
        return low + index * (high - low) / (count - 1);
    };

    /** The series of the pieces with all axes but the first two at these values; none of a skew one. */
    function section(further) {
        const found = [];
        if (skew) return {further, pieces: found};
        for (const piece of pieces) {
            const s = further.map((value, k) => smooth(k + 2, value));
            if (!s.every((x, k) => within(piece, k + 2, x))) continue;
            let series = piece.series;
            for (let k = axes.length - 1; k >= 2; k--) {
                const count = piece.shape[k + 1], rows = series.length / count;
                const b = basis(local(piece, k, s[k - 2]), count, new Float64Array(count));
                const next = new Float64Array(rows);
                for (let r = 0; r < rows; r++) {
                    let sum = 0;
                    for (let m = 0; m < count; m++) sum += series[r * count + m] * b[m];
                    next[r] = sum;
                }
                series = next;
            }
            found.push({...piece, series});
        }
        return {further, pieces: found};
    }

    /** Of the chart's points that have no series the one next to these values: P into p. */
    function evaluated(values) {
        const wanted = values.map((value, k) => {
            const {low, high, count} = axes[k];
            return Math.min(Math.max((value - low) / (high - low) * (count - 1), 0), count - 1);
        });
        // of the corners of the cell of the chart's grid that they are in
        let best = null, least = Infinity;
        for (let corner = 0; corner < 1 << axes.length; corner++) {
            const places = wanted.map((w, k) => (corner >> k & 1 ? Math.ceil(w) : Math.floor(w)));
            const at = places.reduce((sum, i, k) => sum * axes[k].count + i, 0);
            const distance = Math.max(...places.map((i, k) => Math.abs(i - wanted[k])));
            if (alone.at.has(at) && distance < least) [best, least] = [{at, places}, distance];
        }
        if (best === null) return null;
        const i = alone.at.get(best.at);
        for (let k = 0; k <= degree; k++) p[k] = alone.P[k * alone.error.length + i];
        return {error: alone.error[i], values: best.places.map((place, k) => pointAt(k, place))};
    }

    function Omega_and_eta(values) {
        const named = {...data.forcing};
        axes.forEach((axis, k) => { named[axis.name] = values[k]; });
        return [named.Omega, named.eta];
    }

    function unknown() {
        if (p.some((c) => Math.abs(c) === Infinity)) return BEYOND_FLOAT;
        return p.some((c) => Number.isNaN(c)) ? NO_EQUATION : null;
    }

    /** T and the state on a grid of x and y, y slower, from a section. */
    function onGrid(cut, xs, ys) {
        const T = new Float64Array(xs.length * ys.length).fill(NaN);
        const state = new Uint8Array(T.length).fill(UNDECIDED), known = new Uint8Array(T.length);
        const forced = (i, j) => Omega_and_eta([xs[i], ys[j], ...cut.further]);
        const still = !axes.some((axis) => axis.name === "Omega" || axis.name === "eta");
        const fixed = still || xs.length === 0 ? Omega_and_eta([xs[0], ys[0], ...cut.further]) : null;
        const put = (i, j, error) => {
            const at = j * xs.length + i, [Omega, eta] = fixed || forced(i, j);
            const lost = unknown();
            known[at] = 1;
            if (lost !== null) {
                T[at] = Infinity;
                state[at] = lost;
            } else if (Number.isFinite(error)) {
                [T[at], state[at]] = reading.quick(p, error, Omega, eta, re, im);
            } else {
                [T[at]] = reading.quick(p, 0, Omega, eta, re, im);
                state[at] = UNDECIDED;
            }
        };
        const each = (what) => {
            for (let j = 0; j < ys.length; j++) {
                for (let i = 0; i < xs.length; i++) what(i, j, [xs[i], ys[j], ...cut.further]);
            }
        };
        if (skew) {
            each((i, j, values) => {
                const error = summed(values);
                if (error !== null) put(i, j, error);
            });
        }
        for (const piece of cut.pieces) {
            const [n, kx, ky] = piece.shape;
            const own = (k, points) => {
                const found = [];
                points.forEach((value, i) => {
                    const s = smooth(k, value);
                    if (within(piece, k, s)) found.push([i, local(piece, k, s)]);
                });
                return found;
            };
            const rows = own(1, ys).map(([j, y]) => [j, basis(y, ky, new Float64Array(ky))]);
            const bx = new Float64Array(kx), line = new Float64Array(n * ky);
            for (const [i, x] of own(0, xs)) {
                basis(x, kx, bx);
                line.fill(0);
                for (let c = 0; c < n; c++) {
                    for (let a = 0; a < kx; a++) {
                        const start = (c * kx + a) * ky, b = bx[a];
                        for (let m = 0; m < ky; m++) line[c * ky + m] += b * piece.series[start + m];
                    }
                }
                p[0] = 1;
                for (const [j, by] of rows) {
                    for (let c = 0; c < n; c++) {
                        let sum = 0;
                        for (let m = 0; m < ky; m++) sum += line[c * ky + m] * by[m];
                        p[c + 1] = sum;
                    }
                    put(i, j, piece.error);
                }
            }
        }
        if (alone.at.size) {
            each((i, j, values) => {
                const found = known[j * xs.length + i] ? null : evaluated(values);
                if (found !== null) put(i, j, found.error);
            });
        }
        return {T, state};
    }

    /** P at a point from its series: into p; its error, or null where there is none. */
    function summed(values) {
        const s = values.map((value, k) => smooth(k, value, values[forcing]));
        let error = null;
        for (const piece of pieces) {
            if (!s.every((x, k) => within(piece, k, x))) continue;
            let series = piece.series;
            for (let k = axes.length - 1; k >= 0; k--) {
                const count = piece.shape[k + 1], rows = series.length / count;
                const b = basis(local(piece, k, s[k]), count, new Float64Array(count));
                const next = new Float64Array(rows);
                for (let r = 0; r < rows; r++) {
                    let sum = 0;
                    for (let m = 0; m < count; m++) sum += series[r * count + m] * b[m];
                    next[r] = sum;
                }
                series = next;
            }
            p[0] = 1;
            p.set(series, 1);
            error = piece.error;
        }
        return error;
    }

    /**
     * Everything about a point; `nearby` where it is told of the nearest of the chart's own points,
     * and `known` false where there is none.
     */
    function at(values) {
        let error = summed(values), nearby = null;
        if (error === null) {
            const found = evaluated(values);
            if (found !== null) ({error, values: nearby} = found);
        }
        const [Omega, eta] = Omega_and_eta(nearby || values), known = error !== null;
        const lost = known ? unknown() : UNDECIDED;
        let found = {T: Infinity, T_error: Infinity, state: lost, z: [], mu: [], crossing: null};
        if (lost === null) {
            found = reading.solve(p, Number.isFinite(error) ? error : 0, Omega, eta);
            if (!Number.isFinite(error)) Object.assign(found, {state: UNDECIDED, T_error: Infinity});
            found.crossing = reading.crossing(found);
        }
        const P = known ? Array.from(p) : null;
        return {...found, verdict: VERDICTS[found.state], known, P, error, nearby, Omega, eta};
    }

    return {axes, section, onGrid, at};
}

// ---- names ----------------------------------------------------------------------------------

/** A table of frequencies over some axes, between whose points is interpolated. */
function frequenciesOf(data) {
    const {over, points, count} = data.frequencies, values = floats(data.frequencies.values);
    return (at) => {
        let corners = [[0, 1]];
        over.forEach((k, d) => {
            const x = points[d], v = at[k];
            let i = x.findIndex((p) => p > v) - 1;
            if (i < 0) i = v <= x[0] ? 0 : x.length - 2;
            const t = Math.min(Math.max((v - x[i]) / (x[i + 1] - x[i]), 0), 1);
            corners = corners.flatMap(([row, weight]) => [
                [row * x.length + i, weight * (1 - t)], [row * x.length + i + 1, weight * t],
            ]);
        });
        return Array.from({length: count}, (_, j) =>
            corners.reduce((sum, [row, w]) => sum + (w ? w * values[row * count + j] : 0), 0));
    };
}

// Tongues of higher order are narrower; first order opens none where averaging couples nothing. With
// these weights the name is that of the tongue at 771 of 786 points inside one of four charts of the
// report's beams; the others are near where two of the stepped beam's have merged.
const UNLIKELY = 4;

/**
 * The tongues that a point is in, by their edges; where these are not known, the resonance that is
 * nearest to it in Omega and, of a pair, in the angle of its multipliers.
 */
function namesOf(data) {
    const names = data.axes.map((axis) => axis.name), Omega_at = names.indexOf("Omega");
    const frequencies = data.frequencies && frequenciesOf(data);
    const turn = (angle) => {
        const t = Math.abs(angle) % (2 * Math.PI);
        return Math.min(t, 2 * Math.PI - t) / Math.PI;
    };
    const inside = (at) => data.tongues.filter((tongue) => {
        const value = at[1 - Omega_at], y = tongue.y;
        if (value < y[0] || value > y[y.length - 1]) return false;
        const next = y.findIndex((v) => v >= value), i = Math.max(next, 1);
        const t = y[i] > y[i - 1] ? (value - y[i - 1]) / (y[i] - y[i - 1]) : 1;
        const edge = (e) => e[i - 1] + t * (e[i] - e[i - 1]);
        return at[Omega_at] >= edge(tongue.lower) && at[Omega_at] <= edge(tongue.upper);
    });
    return (at, found) => {
        if (found.state !== UNSTABLE) return null;
        if (data.tongues.length) {
            const own = inside(at);
            if (own.length) return {tongue: own.map((tongue) => tongue.name).join(", ")};
        }
        if (!frequencies) return null;
        const w = frequencies(at), [x, y] = found.mu.reduce(
            (a, b) => (modulus(...b) > modulus(...a) ? b : a));
        let best = null, least = Infinity;
        for (const r of data.resonances) {
            if (r.kind !== found.crossing) continue;
            const sum = w[r.i] + r.sign * w[r.j], off = r.order * found.Omega - sum;
            if (!Number.isFinite(sum)) continue;
            let score = Math.abs(off) / (r.order * found.Omega);
            if (r.kind === "pair") {
                const expected = 2 * Math.PI * (w[r.i] + 0.5 * off) / found.Omega;
                score += Math.abs(turn(expected) - turn(Math.atan2(y, x)));
            }
            score *= r.order * (r.opens ? 1 : UNLIKELY);
            if (score < least) [best, least] = [r, score];
        }
        return best && {nearest: best.name};
    };
}
