#pragma once

#include "jobs/import/pbrt/pbrt_context.h"

namespace lacuna::pbrt {

// Colours and spectra as linear RGB of Rec. 709. pbrt-v3 means a spectrum as its RGB build does (a
// flat one has the colour of equal energy); pbrt-v4 means a reflectance under its white light.

/// A reflectance, transmittance or weight.
Rgb reflected_colour(const Context& context, const Parameter& p);
/// Radiance or intensity. pbrt-v4 divides a spectrum or black body by its luminance, and pbrt-v3 a
/// black body by the peak of its spectrum.
Rgb emitted_colour(const Context& context, const Parameter& p);

/// The index of refraction of a conductor: a parameter of RGB, a list, a file or a named metal
/// (pbrt-v4: `metal-Au-eta`). `imaginary` selects the default and the table.
Rgb conductor_index(Context& context, const Parameters& parameters, const char* name,
                    bool imaginary);
/// That of a transparent material: a number, a named glass, or a spectrum at 589 nm (with a note).
double interface_index(Context& context, const Parameters& parameters, const char* name,
                       double otherwise);

/// Colours of a `ColorSpace` by its name in the file. Throws SceneError.
ColourSpace colour_space(const std::string& name, const Place& place);

}  // namespace lacuna::pbrt
