/* plot_dfg.c - the tables of split-sum light (src/ibl/dfg.h): what facet multiplies prefiltered light with. */
#include "ibl/ibl.h"
#include "plot/plot_build.h"

enum { SIZE = 192 };

typedef enum dfg_quantity { DFG_SCALE, DFG_BIAS, DFG_LOST, DFG_SHEEN } dfg_quantity;

static double value_of(dfg_quantity what, float NdotV, float roughness)
{
    float terms[2];
    if (what == DFG_SHEEN)
        return (double)ibl_sheen_albedo(NdotV, roughness);
    ibl_dfg(NdotV, roughness, terms);
    return what == DFG_SCALE  ? (double)terms[0]
           : what == DFG_BIAS ? (double)terms[1]
                              : 1.0 - (double)(terms[0] + terms[1]);
}

static void add_table(plot *p, dfg_quantity what, const char *title, const char *label, const char *note,
                      double maximum)
{
    plot_panel *panel = plot_add_panel(p, CHART_FIELD, title, "N.V", "perceptual roughness");
    double *values;
    chart_field *field = plot_add_field(p, panel, SIZE, SIZE, CHART_LINEAR, label, &values);
    if (!field)
        return;
    /* rows from the top, places in the middles of the cells */
    for (int row = 0; row < SIZE; row++)
        for (int column = 0; column < SIZE; column++)
            values[row * SIZE + column] =
                value_of(what, ((float)column + 0.5f) / SIZE, 1.0f - ((float)row + 0.5f) / SIZE);
    field->x0 = field->y0 = field->minimum = 0.0;
    field->maximum = maximum;
    panel->panel.note = note;
    plot_set_range(&panel->panel.x, 0.0, 1.0);
    plot_set_range(&panel->panel.y, 0.0, 1.0);
}

facet_result plot_make_dfg(plot *p)
{
    add_table(p, DFG_SCALE, "scale A", "A", "reflectance = F0 A + F90 B (Karis 2013), height-correlated GGX",
              1.0);
    add_table(p, DFG_BIAS, "bias B", "B", "the share of F90: what grazing views add", 0.0);
    add_table(p, DFG_LOST, "light that scatters more than once", "1 - (A + B)",
              "returned by the compensation of Fdez-Aguera 2019", 0.0);
    add_table(p, DFG_SHEEN, "albedo of sheen", "E",
              "Charlie, Estevez and Kulla 2017; more than 1 at smooth grazing rims is shown as 1", 1.0);
    return plot_finish(p, "Tables of split-sum light", 2, 1060, 960);
}
