/* dwaLookups.h - replaces OpenEXR's tables of the DWA compression. Only decoding is possible: the encoder's tables are empty. */

/* DWA stores x^(1/2.2) up to 1 and a logarithm above; this is its inverse, by the constants of the library's table. */
static half to_linear(half x)
{
    if (!x.isFinite())
        return half(0.0f);
    const float magnitude = std::fabs(static_cast<float>(x));
    const float base = static_cast<float>(std::pow(2.7182818, 2.2));
    const double linear =
        magnitude <= 1.0f ? std::pow(magnitude, 2.2f) : std::pow(base, static_cast<float>(magnitude - 1.0));
    return half(static_cast<float>(x < 0.0f ? -linear : linear));
}

static half keep(half x)
{
    return x;
}

static const half_table dwaCompressorToLinear(to_linear);
static const half_table dwaCompressorNoOp(keep);
static const unsigned short dwaCompressorToNonlinear[1] = {0};
static const unsigned short closestData[1] = {0};
static const unsigned int closestDataOffset[1] = {0};
