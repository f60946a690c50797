/* Half a period of u'' = -(x F - shift) u - sum_i w_i cos(p_i theta) G_i u, LANES points side by
 * side, and what P(z) needs of it. The same recurrence as floquet/batch/numpy_kernel.py; N
 * coordinates, TERMS cosines, Taylor ORDER, COLUMNS of U taken at once (a divisor of 2 N), BLOCK sums
 * kept in registers (a multiple of COLUMNS). These and every other number that Python has too are set
 * on the compiler's command line, by floquet/batch/c_kernel.py: POWERS, TINY (keeps v > 0 where a row
 * of S is 0), RADII, RADII_ORDER, MAX_EXPONENT, MAX_MINORS, MAX_LANES,
 * PRODUCTS_SHARE. */

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* As wide as the machine's vectors: twice as many take eleven times as long with AVX2. */
#if defined(__AVX512F__)
#define LANES 8
#elif defined(__AVX__)
#define LANES 4
#else
#define LANES 2
#endif
#define WIDE (2 * N)
#define MAX_KEPT 64 /* steps whose cosines are kept for the next columns */

_Static_assert(LANES <= MAX_LANES, "COLUMNS are counted for MAX_LANES");
_Static_assert(WIDE % COLUMNS == 0 && BLOCK % COLUMNS == 0, "whole columns");
_Static_assert(MAX_MINORS == 3, "polynomial() has the minors of 3 rows and no more");

#define FLAT (N * COLUMNS)
#define INLINE static inline __attribute__((always_inline))

typedef double lanes __attribute__((vector_size(8 * LANES)));
typedef long long bits __attribute__((vector_size(8 * LANES)));

/* The larger of top and |x|, lane by lane; top where x is not a number, which the end tells. */
INLINE lanes larger(lanes top, lanes x)
{
    x = (lanes)((bits)x & 0x7fffffffffffffffLL);
    bits more = x > top;
    return (lanes)(((bits)x & more) | ((bits)top & ~more));
}

/* Taylor coefficients of cos(p (theta + x h)) in x, one series a cosine. */
static void cosines(double *series, const int *phases, double theta, double h)
{
    for (int i = 0; i < TERMS; i++) {
        double p = phases[i], c = cos(p * theta), s = sin(p * theta), turn = 1.0;
        const double cycle[4] = {c, -s, -c, s};
        for (int j = 0; j < ORDER; j++) {
            *series++ = cycle[j % 4] * turn;
            turn *= p * h / (j + 1);
        }
    }
}

/* Collatz and Wielandt: for any v > 0 the Perron root of S >= 0 is at most max (S v)_i / v_i.
 * Infinite where S is not finite, or not known to be. */
static double perron_root(int size, const double *S)
{
    double v[WIDE], moved[WIDE], bound = INFINITY;
    for (int r = 0; r < size; r++)
        v[r] = 1.0;
    for (int round = 0; round < POWERS; round++) {
        double worst = 0.0, sum = 0.0;
        for (int r = 0; r < size; r++) {
            moved[r] = 0.0;
            for (int c = 0; c < size; c++)
                moved[r] += S[r * size + c] * v[c];
            worst = fmax(worst, moved[r] / v[r]);
            sum += moved[r];
        }
        if (!(sum < INFINITY))
            return INFINITY;
        bound = fmin(bound, worst);
        if (sum == 0.0) /* nothing is left of v: S is nilpotent */
            return 0.0;
        for (int r = 0; r < size; r++)
            v[r] = moved[r] / sum + TINY;
    }
    return bound;
}

/* floquet.integrate.step_length.longest_step and rate, with the moduli of the matrices a group has at most. */
static double longest_step(const double *worst, const int *phases, const double *radii,
                           double tolerance, double *rate)
{
    double S[N * N] = {0.0}, longest = 0.0;
    int forcing = 0;
    for (int i = 0; i <= TERMS; i++) {
        for (int e = 0; e < N * N; e++)
            S[e] += worst[i * N * N + e];
        if (i && phases[i - 1] > forcing)
            forcing = phases[i - 1];
    }
    *rate = sqrt(perron_root(N, S)) + forcing;
    for (int k = 0; k < RADII; k++) {
        double R = radii[k] * (ORDER + 1) / RADII_ORDER / *rate;
        memcpy(S, worst, sizeof S);
        for (int i = 1; i <= TERMS; i++) {
            double swell = cosh(fmin(phases[i - 1] * R, MAX_EXPONENT / 2));
            for (int e = 0; e < N * N; e++)
                S[e] += swell * worst[i * N * N + e];
        }
        double growth = fmin(R * sqrt(perron_root(N, S)), MAX_EXPONENT);
        double share = exp((log(0.5 * tolerance) - growth) / (ORDER + 1));
        longest = fmax(longest, R * fmin(share, 0.5));
    }
    return longest;
}

/* sum[e] = w sum_j series[k - j] a[j][e] for `width` elements, which stay in registers. */
INLINE void convolve(int width, int k, const double *series, lanes w, const lanes *a, lanes *sum)
{
    lanes s[BLOCK];
    memset(s, 0, sizeof s);
    for (int j = 0; j <= k; j++)
        for (int e = 0; e < width; e++)
            s[e] += series[k - j] * a[j * FLAT + e];
    for (int e = 0; e < width; e++)
        sum[e] = w * s[e];
}

/* next[r] = factor (shift now[r] - sum_i matrix_i[r] . load_i) for `rows` rows of each matrix. */
INLINE void combine(int rows, const double *matrices, const lanes (*load)[FLAT], const lanes *now,
                    lanes shift, double factor, lanes *next)
{
    lanes s[BLOCK];
    for (int e = 0; e < rows * COLUMNS; e++)
        s[e] = shift * now[e];
    for (int i = 0; i <= TERMS; i++)
        for (int q = 0; q < N; q++)
            for (int r = 0; r < rows; r++)
                for (int c = 0; c < COLUMNS; c++)
                    s[r * COLUMNS + c] -= matrices[(i * N + r) * N + q] * load[i][q * COLUMNS + c];
    for (int e = 0; e < rows * COLUMNS; e++)
        next[e] = factor * s[e];
}

/* One Taylor step of some columns: a[0], a[1] hold u and h u' at its start, and at its end. */
static void advance(lanes a[ORDER + 1][FLAT], const double *matrices, const double *cosine,
                    const lanes *weights, lanes shift, double hh)
{
    enum { ROWS = BLOCK / COLUMNS, LEFT = FLAT % BLOCK, ROWS_LEFT = N % (BLOCK / COLUMNS) };
    for (int k = 0; k + 2 <= ORDER; k++) {
        lanes load[1 + TERMS][FLAT];
        for (int e = 0; e < FLAT; e++)
            load[0][e] = weights[0] * a[k][e];
        for (int i = 1; i <= TERMS; i++) {
            const double *series = cosine + (i - 1) * ORDER;
            int e = 0;
            for (; e + BLOCK <= FLAT; e += BLOCK)
                convolve(BLOCK, k, series, weights[i], &a[0][e], &load[i][e]);
            convolve(LEFT, k, series, weights[i], &a[0][e], &load[i][e]);
        }
        double factor = hh / ((k + 1.0) * (k + 2.0));
        int r = 0;
        for (; r + ROWS <= N; r += ROWS)
            combine(ROWS, matrices + r * N, load, &a[k][r * COLUMNS], shift, factor,
                    &a[k + 2][r * COLUMNS]);
        combine(ROWS_LEFT, matrices + r * N, load, &a[k][r * COLUMNS], shift, factor,
                &a[k + 2][r * COLUMNS]);
    }
    for (int e = 0; e < FLAT; e++) {
        lanes position = a[ORDER][e], velocity = ORDER * a[ORDER][e];
        for (int k = ORDER - 1; k >= 1; k--) {
            position += a[k][e];
            velocity += k * a[k][e];
        }
        a[0][e] += position;
        a[1][e] = velocity;
    }
}

/* Inverse of a matrix by Gauss and Jordan with pivoting; 0 where there is none. */
static int invert(double m[WIDE][2 * WIDE])
{
    for (int k = 0; k < WIDE; k++) {
        int best = k;
        for (int r = k + 1; r < WIDE; r++)
            if (fabs(m[r][k]) > fabs(m[best][k]))
                best = r;
        if (!(fabs(m[best][k]) > 0.0))
            return 0;
        if (best != k)
            for (int c = 0; c < 2 * WIDE; c++) {
                double swapped = m[k][c];
                m[k][c] = m[best][c];
                m[best][c] = swapped;
            }
        double over = 1.0 / m[k][k];
        for (int c = k; c < 2 * WIDE; c++)
            m[k][c] *= over;
        for (int r = 0; r < WIDE; r++) {
            double times = m[r][k];
            if (r != k && times != 0.0)
                for (int c = k; c < 2 * WIDE; c++)
                    m[r][c] -= times * m[k][c];
        }
    }
    return 1;
}

/* A = 2 p a - I, the first block of scale = |U^-1| top, and a bound on scale's Perron root; top is
 * the largest that each element of |U| has been. */
static double finish(double U[WIDE][WIDE], double top[WIDE][WIDE], double A[N][N],
                     double first[N][N])
{
    double m[WIDE][2 * WIDE], scale[WIDE * WIDE] = {0.0};
    for (int r = 0; r < WIDE; r++)
        for (int c = 0; c < WIDE; c++) {
            m[r][c] = U[r][c];
            m[r][WIDE + c] = r == c;
        }
    int sound = invert(m);
    for (int r = 0; r < WIDE; r++)
        for (int q = 0; q < WIDE; q++)
            for (int c = 0; c < WIDE; c++)
                scale[r * WIDE + c] += fabs(m[r][WIDE + q]) * top[q][c];
    for (int r = 0; r < N; r++)
        for (int c = 0; c < N; c++) {
            double sum = 0.0;
            for (int q = 0; q < N; q++)
                sum += m[r][WIDE + q] * U[q][c];
            A[r][c] = 2.0 * sum - (r == c);
            first[r][c] = scale[r * WIDE + c];
        }
    return sound ? perron_root(WIDE, scale) : INFINITY;
}

#if N <= MAX_MINORS
/* floquet.charpoly: coefficients as sums of principal minors, and how rounding in A moves them. */
static void polynomial(double A[N][N], double first[N][N], double *P, double *sensitivity)
{
    double B[N][N] = {{0.0}};
    memset(P, 0, sizeof(double) * (N + 1));
    P[0] = 1.0;
    for (int i = 0; i < N; i++) {
        B[i][i] = 1.0;
        P[1] -= A[i][i];
        for (int j = i + 1; j < N; j++)
            P[2] += A[i][i] * A[j][j] - A[i][j] * A[j][i];
    }
#if N == 3
    P[3] = -(A[0][0] * (A[1][1] * A[2][2] - A[1][2] * A[2][1])
             - A[0][1] * (A[1][0] * A[2][2] - A[1][2] * A[2][0])
             + A[0][2] * (A[1][0] * A[2][1] - A[1][1] * A[2][0]));
#endif
    *sensitivity = 0.0;
    /* a minor's rounding is of the size of its products, whatever they cancel */
    double summed = 0.0;
#if N == 3
    double a[N][N], second = 0.0, third;
    for (int i = 0; i < N; i++)
        for (int j = 0; j < N; j++)
            a[i][j] = fabs(A[i][j]);
    third = a[0][0] * a[1][1] * a[2][2] + a[0][1] * a[1][2] * a[2][0] + a[0][2] * a[2][1] * a[1][0];
    for (int i = 0; i < N; i++) {
        int j = (i + 1) % N, k = (i + 2) % N;
        second += a[i][i] * a[j][j] + a[i][j] * a[j][i];
        third += a[i][j] * a[j][i] * a[k][k];
    }
    summed = PRODUCTS_SHARE * fmax(second, third);
#endif
    for (int j = 0; j < N; j++) {
        double moved = 0.0, next[N][N];
        for (int r = 0; r < N; r++)
            for (int c = 0; c < N; c++) {
                moved += B[r][c] * first[c][r] * (B[r][c] * first[c][r]);
                next[r][c] = r == c ? P[j + 1] : 0.0;
                for (int q = 0; q < N; q++)
                    next[r][c] += A[r][q] * B[q][c];
            }
        *sensitivity = fmax(*sensitivity, sqrt(moved));
        memcpy(B, next, sizeof B);
    }
    *sensitivity += summed;
}
#endif

/* matrices (1 + TERMS, N, N); weights (1 + TERMS, points); shift (points); phases (TERMS);
 * radii (RADII). Out: for N <= MAX_MINORS P (points, N + 1) and its sensitivity (points), beyond that A and
 * first (points, N, N); growth and rate (points). Growth is infinite where the steps would be more
 * than `most`. Returns 0, or 1 without memory. */
int march(int points, const double *matrices, const double *weights, const double *shift,
          const int *phases, const double *radii, double tolerance, double most, double *one,
          double *other, double *growth, double *rate)
{
    lanes(*a)[FLAT] = aligned_alloc(64, sizeof(lanes[ORDER + 1][FLAT]));
    double(*U)[WIDE][WIDE] = malloc(sizeof(double[2 * LANES][WIDE][WIDE]));
    double(*peak)[WIDE][WIDE] = U + LANES;
    double *series = malloc(sizeof(double) * TERMS * ORDER * MAX_KEPT);
    if (!a || !U || !series) {
        free(a);
        free(U);
        free(series);
        return 1;
    }
    for (int start = 0; start < points; start += LANES) {
        int filled = points - start < LANES ? points - start : LANES;
        lanes w[1 + TERMS], s;
        double worst[(1 + TERMS) * N * N], largest[1 + TERMS] = {0.0}, most_shift = 0.0, fastest;
        for (int l = 0; l < LANES; l++) {
            int point = start + (l < filled ? l : filled - 1);
            s[l] = shift[point];
            most_shift = fmax(most_shift, s[l]);
            for (int i = 0; i <= TERMS; i++) {
                w[i][l] = weights[(size_t)i * points + point];
                largest[i] = fmax(largest[i], fabs(w[i][l]));
            }
        }
        for (int i = 0; i <= TERMS; i++)
            for (int e = 0; e < N * N; e++)
                worst[i * N * N + e] = largest[i] * fabs(matrices[i * N * N + e]);
        for (int r = 0; r < N; r++)
            worst[r * N + r] += most_shift;
        double pi = acos(-1.0);
        double steps = ceil(pi / longest_step(worst, phases, radii, tolerance, &fastest));
        int within = steps >= 1.0 && steps <= most;
        double h = pi / steps;

        /* the columns of U do not know of each other: a few at a time stay in the nearest cache */
        for (int first = 0; first < WIDE; first += COLUMNS) {
            memset(a, 0, 2 * sizeof(lanes[FLAT]));
            for (int c = 0; c < COLUMNS; c++) {
                int r = (first + c) % N, derivative = first + c >= N;
                for (int l = 0; l < LANES; l++)
                    a[derivative][r * COLUMNS + c][l] = derivative ? h : 1.0;
            }
            lanes top[2][FLAT];
            for (int e = 0; e < FLAT; e++)
                for (int d = 0; d < 2; d++)
                    top[d][e] = larger((lanes){0.0}, a[d][e]);
            for (int step = 0; within && step < steps; step++) {
                double *own = series + (step % MAX_KEPT) * TERMS * ORDER;
                if (first == 0 || steps > MAX_KEPT)
                    cosines(own, phases, step * h, h);
                advance(a, matrices, own, w, s, h * h);
                for (int e = 0; e < FLAT; e++)
                    for (int d = 0; d < 2; d++)
                        top[d][e] = larger(top[d][e], a[d][e]);
            }
            for (int l = 0; l < LANES; l++)
                for (int r = 0; r < N; r++)
                    for (int c = 0; c < COLUMNS; c++) {
                        U[l][r][first + c] = a[0][r * COLUMNS + c][l];
                        U[l][N + r][first + c] = a[1][r * COLUMNS + c][l] / h;
                        peak[l][r][first + c] = top[0][r * COLUMNS + c][l];
                        peak[l][N + r][first + c] = top[1][r * COLUMNS + c][l] / h;
                    }
        }
        for (int l = 0; l < filled; l++) {
            double A[N][N], block[N][N];
            size_t point = start + l;
            growth[point] = finish(U[l], peak[l], A, block);
#if N <= MAX_MINORS
            polynomial(A, block, one + point * (N + 1), other + point);
#else
            memcpy(one + point * N * N, A, sizeof A);
            memcpy(other + point * N * N, block, sizeof block);
#endif
            rate[point] = fastest;
            if (!within)
                growth[point] = INFINITY;
        }
    }
    free(a);
    free(U);
    free(series);
    return 0;
}
