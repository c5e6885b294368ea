// The colours of curves, as style.css names them.

export const colours = 8;

/// The i-th curve's colour; after eight they come again.
export const curveColour = (i) => `var(--curve-${i % colours})`;
