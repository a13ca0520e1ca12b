/* b44ExpLogTable.h - replaces OpenEXR's tables of the B44 compression: exp(x / 8) for channels that it stores as logarithms. The
 * encoder's logarithms are left out. */
static half exp_of_eighth(half x)
{
    const float largest = 65504.0f;
    if (!x.isFinite())
        return half(0.0f);
    return half(x >= 8.0 * std::log(static_cast<double>(largest)) ? largest : std::exp(x / 8.0f));
}

static const half_table expTable(exp_of_eighth);
static const unsigned short logTable[1] = {0};
