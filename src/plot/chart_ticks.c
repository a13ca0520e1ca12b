/* chart_ticks.c - see chart_ticks.h. */
#include "plot/chart_ticks.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- numbers ---- */

/* Replaces the decimal point of any locale by ".". */
static void set_point(char *text)
{
    char *p = text + (*text == '-');
    while (*p >= '0' && *p <= '9')
        p++;
    if (*p == 0 || *p == 'e' || *p == '.')
        return;
    char *after = p;
    while (*after && *after != 'e' && !(*after >= '0' && *after <= '9'))
        after++;
    *p = '.';
    memmove(p + 1, after, strlen(after) + 1);
}

/* Adds one to the last digit of the significand of text, "d.ddde-dd"; false: all are 9. */
static bool add_one(char *text)
{
    char *e = strchr(text, 'e');
    if (!e)
        return false;
    for (char *p = e - 1; p >= text && *p != '-'; p--) {
        if (*p < '0' || *p > '9')
            continue;
        if (*p != '9') {
            (*p)++;
            return true;
        }
        *p = '0';
    }
    return false;
}

/* A decimal of that many digits that reads back as value. The nearest decimal may not: below a power of
 * two doubles are twice as dense, so the next one above may read back where the nearest, below, does not. */
static bool find_digits(double value, int digits, char out[NUMBER_SIZE])
{
    snprintf(out, NUMBER_SIZE, "%.*g", digits, value);
    if (strtod(out, NULL) == value)
        return true;
    int exponent;
    if (fabs(frexp(value, &exponent)) != 0.5)
        return false;
    char next[NUMBER_SIZE];
    snprintf(next, sizeof next, "%.*e", digits - 1, value);
    if (!add_one(next) || strtod(next, NULL) != value)
        return false;
    memcpy(out, next, sizeof next);
    return true;
}

void number_shortest(double value, char out[NUMBER_SIZE])
{
    if (isnan(value) || isinf(value)) {
        strcpy(out, isnan(value) ? "" : value > 0.0 ? "inf" : "-inf");
        return;
    }
    /* 15 digits hold every shorter decimal, except where doubles have fewer bits */
    for (int digits = fabs(value) < DBL_MIN ? 1 : 15; digits <= 17; digits++)
        if (find_digits(value, digits, out))
            break;
    set_point(out);
}

void number_label(double value, int decimals, char out[NUMBER_SIZE])
{
    char digits[NUMBER_SIZE];
    decimals = decimals < 0 ? 0 : decimals > 17 ? 17 : decimals;
    /* too long for a label: a power of ten is used instead */
    int length = fabs(value) < 1e9 ? snprintf(digits, sizeof digits, "%.*f", decimals, value)
                                   : snprintf(digits, sizeof digits, "%.6g", value);
    if (length < 0 || length >= NUMBER_SIZE - 4)
        snprintf(digits, sizeof digits, "%.6g", value);
    set_point(digits);
    const char *p = digits;
    bool is_negative = *p == '-';
    p += is_negative;
    if (strspn(p, "0.") == strlen(p))
        is_negative = false;
    snprintf(out, NUMBER_SIZE, "%s%.27s", is_negative ? "\xe2\x88\x92" : "", p);
}

/* ---- ticks ---- */

static const double LARGEST = 1e300; /* differences of such numbers are finite */

void ticks_range(chart_scale scale, double *minimum, double *maximum)
{
    double low = fmin(fmax(*minimum, -LARGEST), LARGEST), high = fmin(fmax(*maximum, -LARGEST), LARGEST);
    if (!(*minimum <= *maximum) || (scale == CHART_LOG10 && !(high > 0.0))) {
        *minimum = scale == CHART_LOG10 ? 0.1 : 0.0;
        *maximum = 1.0;
        return;
    }
    if (scale == CHART_LOG10) {
        low = fmax(low, 1e-300);
        high = fmax(high, 1e-300);
        if (!(high / low > 1.0 + 1e-9)) {
            low /= low > 1e-299 ? 3.0 : 1.0;
            high *= 3.0;
        }
    } else if (high - low <=
               fmax(1e-9 * fmax(fabs(low), fabs(high)), 1e-290)) { /* constant except for rounding */
        const double reach = 1.25 * fmax(fabs(low), fabs(high));
        if (reach < 1e-290) {
            low = -1.0;
            high = 1.0;
        } else if (high > 0.0) {
            low = 0.0;
            high = fmin(reach, LARGEST);
        } else {
            low = fmax(-reach, -LARGEST);
            high = 0.0;
        }
    } else if (low > 0.0 && low < 0.35 * high) { /* heights are compared from 0 */
        low = 0.0;
    } else if (high < 0.0 && high > 0.35 * low) {
        high = 0.0;
    }
    *minimum = low;
    *maximum = high;
}

/* ---- linear ---- */

/* A candidate step: ticks are first * step .. last * step. */
typedef struct candidate {
    double digit; /* step = digit * 10^power, which need not be a double */
    int power;
    double first, last;
} candidate;

/* k * digit * 10^power, the double nearest to that decimal: 3 * 0.1 is not 0.3, but 3 / 10 is. */
static double tick_at(const candidate *c, double k)
{
    const double digits = k * c->digit;
    if (digits == 0.0)
        return 0.0;
    return c->power < 0 ? digits / pow(10.0, -c->power) : digits * pow(10.0, c->power);
}

static candidate make_candidate(const ticks_desc *d, double digit, int power)
{
    candidate c = {.digit = digit, .power = power};
    const double step = tick_at(&c, 1.0);
    const double low = d->minimum / step, high = d->maximum / step;
    /* a range that ends on a tick, except for rounding, includes it */
    const double slack = 1e-9 * fmax(1.0, high - low);
    c.first = d->is_fixed ? ceil(low - slack) : floor(low + slack);
    c.last = d->is_fixed ? floor(high + slack) : ceil(high - slack);
    return c;
}

/* The score of ticks by Talbot, Lin and Hanrahan 2010, "An extension of Wilkinson's algorithm for
 * positioning tick labels on axes", with their weights for the roundness of the step (1: best), the
 * coverage of the range, and the density. */
static double score(const ticks_desc *d, const candidate *c, double roundness)
{
    const double range = d->maximum - d->minimum, first = tick_at(c, c->first), last = tick_at(c, c->last);
    const double below = (d->minimum - first) / (0.1 * range), above = (d->maximum - last) / (0.1 * range);
    const double coverage = 1.0 - 0.5 * (below * below + above * above);
    const double density = (c->last - c->first) / (last - first);
    const double shown = fmax(last, d->maximum) - fmin(first, d->minimum);
    const double wanted = (d->target - 1) / shown;
    const double fit = 2.0 - fmax(density / wanted, wanted / density);
    return 0.25 * roundness + 0.2 * coverage + 0.5 * fit;
}

/* The best of those with at most limit ticks; digit 0: there is none. */
static candidate choose_step(const ticks_desc *d, double limit)
{
    /* in order of preference */
    static const double DIGITS[] = {1.0, 5.0, 2.0, 2.5, 3.0};
    static const double DEGREES[] = {30.0, 10.0, 15.0, 45.0, 20.0, 90.0, 5.0, 60.0, 180.0, 2.0, 1.0};
    const double range = d->maximum - d->minimum;
    const bool has_angles = d->is_degrees && range >= 5.0 && range <= 3600.0;
    const double *digits = has_angles ? DEGREES : DIGITS;
    const int digit_count = has_angles ? 11 : 5, power = (int)floor(log10(range / d->target));
    candidate best = {.digit = 0.0};
    double best_score = -HUGE_VAL;
    for (int p = has_angles ? 0 : power - 1; p <= (has_angles ? 0 : power + 2); p++)
        for (int i = 0; i < digit_count; i++) {
            const candidate c = make_candidate(d, digits[i], p);
            const double count = c.last - c.first + 1.0;
            if (!(count >= 2.0 && count <= limit))
                continue;
            const double s = score(d, &c, 1.0 - (double)i / (digit_count - 1));
            if (s > best_score) {
                best = c;
                best_score = s;
            }
        }
    return best;
}

/* Decimals that digit * 10^power needs. */
static int decimals_of(const candidate *c)
{
    const int decimals = (c->digit == 2.5 ? 1 : 0) - c->power;
    return decimals > 0 ? decimals : 0;
}

/* The power of ten that long labels omit: |largest| from 1e5 or below 1e-3. */
static int common_power(const candidate *c, double largest)
{
    const int magnitude = largest > 0.0 ? (int)floor(log10(largest) + 1e-12) : 0;
    if (magnitude >= 5 || magnitude < -3 || decimals_of(c) > 6)
        return magnitude;
    return 0;
}

static void label_linear(const candidate *c, bool is_degrees, ticks *out)
{
    double largest = 0.0;
    for (int i = 0; i < out->count; i++)
        largest = fmax(largest, fabs(out->values[i]));
    out->power = common_power(c, largest);
    candidate shown = *c;
    shown.power -= out->power;
    for (int i = 0; i < out->count; i++) {
        tick_label *label = &out->labels[i];
        number_label(tick_at(&shown, c->first + i), decimals_of(&shown), label->text);
        label->exponent[0] = 0;
        const size_t length = strlen(label->text);
        if (is_degrees && out->power == 0 && length + 3 <= sizeof label->text)
            memcpy(label->text + length, "\xc2\xb0", 3);
    }
}

/* Minor ticks: five or four per step, whichever divides it. */
static void add_minor(const candidate *c, ticks *out)
{
    const int parts = c->digit == 2.0 || c->digit == 20.0 ? 4 : c->digit == 3.0 || c->digit == 30.0 ? 3 : 5;
    candidate minor = *c;
    for (int i = -1; i <= out->count; i++)
        for (int k = 1; k < parts; k++) {
            const double value = tick_at(&minor, c->first + i + (double)k / parts);
            if (value >= out->minimum && value <= out->maximum && out->minor_count < TICKS_MINOR_MAX)
                out->minor[out->minor_count++] = value;
        }
}

static void create_linear(const ticks_desc *desc, ticks *out)
{
    /* a fixed range has as many as suit it; a range widened for few ticks would be mostly empty */
    candidate c = choose_step(desc, desc->is_fixed ? desc->target + 1 : fmin(2 * desc->target, TICKS_MAX));
    if (c.digit == 0.0)
        c = choose_step(desc, TICKS_MAX);
    if (c.digit == 0.0) /* no step fits: no ticks are better than wrong ones */
        return;
    if (!desc->is_fixed) {
        out->minimum = fmin(out->minimum, tick_at(&c, c.first));
        out->maximum = fmax(out->maximum, tick_at(&c, c.last));
    }
    for (double k = c.first; k <= c.last && out->count < TICKS_MAX; k++)
        out->values[out->count++] = fmin(fmax(tick_at(&c, k), out->minimum), out->maximum);
    label_linear(&c, desc->is_degrees, out);
    add_minor(&c, out);
}

/* ---- logarithmic ---- */

static void label_power(int exponent, bool is_plain, tick_label *label)
{
    label->exponent[0] = 0;
    if (is_plain) {
        number_label(exponent < 0 ? 1.0 / pow(10.0, -exponent) : pow(10.0, exponent),
                     exponent < 0 ? -exponent : 0, label->text);
        return;
    }
    strcpy(label->text, "10");
    snprintf(label->exponent, sizeof label->exponent, "%s%d", exponent < 0 ? "\xe2\x88\x92" : "",
             exponent < 0 ? -exponent : exponent);
}

/* 10^exponent * digit, rounded once if possible. */
static double power_of_ten(int exponent, double digit)
{
    return exponent < 0 ? digit / pow(10.0, -exponent) : digit * pow(10.0, exponent);
}

/* 1, 2 and 5 of each decade; within about one decade more of them. */
static void create_mantissas(bool is_one_decade, ticks *out)
{
    static const double FEW[] = {1.0, 2.0, 5.0}, MORE[] = {1.0, 2.0, 3.0, 4.0, 6.0, 8.0};
    const double *digits = is_one_decade ? MORE : FEW;
    const int digit_count = is_one_decade ? 6 : 3;
    const int first = (int)floor(log10(out->minimum)), last = (int)ceil(log10(out->maximum));
    for (int e = first; e <= last; e++)
        for (int i = 0; i < digit_count; i++) {
            const double value = power_of_ten(e, digits[i]);
            if (value < out->minimum * (1.0 - 1e-9) || value > out->maximum * (1.0 + 1e-9) ||
                out->count == TICKS_MAX)
                continue;
            tick_label *label = &out->labels[out->count];
            *label = (tick_label){.text = ""};
            if (e >= -4 && e <= 5) {
                number_label(value, e < 0 ? -e : 0, label->text);
            } else {
                label_power(e, false, label);
                if (i > 0)
                    snprintf(label->text, sizeof label->text, "%.0f\xc2\xb7%s", digits[i], "10");
            }
            out->values[out->count++] = fmin(fmax(value, out->minimum), out->maximum);
        }
}

/* One tick every several decades. */
static void create_decades(int target, ticks *out)
{
    static const int STEPS[] = {1, 2, 3, 5, 10, 20, 50, 100, 200};
    const int first = (int)ceil(log10(out->minimum) - 1e-9), last = (int)floor(log10(out->maximum) + 1e-9);
    int step = 0;
    for (int i = 0; i < 9 && (step == 0 || (last - first) / step + 1 > target); i++)
        step = STEPS[i];
    /* counted from 10^0 */
    const int start = (first >= 0 ? (first + step - 1) / step : -(-first / step)) * step;
    const bool is_plain = first >= -3 && last <= 4;
    for (int e = start; e <= last && out->count < TICKS_MAX; e += step) {
        label_power(e, is_plain, &out->labels[out->count]);
        out->values[out->count++] = fmin(fmax(power_of_ten(e, 1.0), out->minimum), out->maximum);
    }
    for (int e = first; step > 1 && last - first <= 40 && e <= last; e++)
        if (e % step != 0)
            out->minor[out->minor_count++] = fmin(fmax(power_of_ten(e, 1.0), out->minimum), out->maximum);
}

static void create_logarithmic(const ticks_desc *desc, ticks *out)
{
    double decades = log10(out->maximum) - log10(out->minimum);
    if (!desc->is_fixed) {
        /* widened to whole decades, or to 1, 2, 5 of one if the whole would be mostly empty */
        static const double DIGITS[] = {1.0, 2.0, 5.0, 10.0};
        const int low = (int)floor(log10(out->minimum) + 1e-9), high = (int)floor(log10(out->maximum) - 1e-9);
        double minimum = power_of_ten(low, 1.0), maximum = power_of_ten(high, 10.0);
        for (int i = 0; i < 4 && decades < 3.0; i++)
            if (power_of_ten(low, DIGITS[i]) <= out->minimum * (1.0 + 1e-9))
                minimum = power_of_ten(low, DIGITS[i]);
        for (int i = 3; i >= 0 && decades < 3.0; i--)
            if (power_of_ten(high, DIGITS[i]) >= out->maximum * (1.0 - 1e-9))
                maximum = power_of_ten(high, DIGITS[i]);
        out->minimum = fmin(minimum, out->minimum);
        out->maximum = fmax(maximum, out->maximum);
        decades = log10(out->maximum) - log10(out->minimum);
    }
    if (decades < 0.7) { /* less than 1 to 5: as on a linear axis */
        create_linear(
            &(ticks_desc){
                .minimum = out->minimum, .maximum = out->maximum, .is_fixed = true, .target = desc->target},
            out);
        return;
    }
    if (decades < 2.3 && desc->target >= 4)
        create_mantissas(decades < 1.2 && desc->target >= 6, out);
    else
        create_decades(desc->target, out);
    if (decades > 12.0)
        return;
    const int first = (int)floor(log10(out->minimum)), last = (int)ceil(log10(out->maximum));
    for (int e = first; e <= last; e++)
        for (int digit = 2; digit <= 9 && out->minor_count < TICKS_MINOR_MAX; digit++) {
            const double value = power_of_ten(e, digit);
            if (value > out->minimum && value < out->maximum)
                out->minor[out->minor_count++] = value;
        }
}

void ticks_create(const ticks_desc *desc, ticks *out)
{
    out->minimum = desc->minimum;
    out->maximum = desc->maximum;
    out->count = out->minor_count = out->power = 0;
    if (desc->scale == CHART_LOG10)
        create_logarithmic(desc, out);
    else
        create_linear(desc, out);
}
