/* How high and wide the panels are, on the screen and on paper. */

export const HEIGHTS = { input: 92, output: 178, residual: 112 };
export const PAPER = { input: 76, output: 150, residual: 96 };    // a trial with two outputs fills a page
export const AXIS = 52;          // px; the same in every panel, so that they stand under one another
export const BESIDE = 22;        // px right of the plots: half of the last time, which stands under the end
export const CLOCK = 30;         // px below the panels that carry the time axis
export const LOW = 100;          // px; a panel below this height, as of an input, would else have a single number on its axis

const PRINTED = 690;             // px; the width of an A4 page between its margins

export const onPaper = () => document.documentElement.dataset.print !== undefined;

export const widthOf = (box) => (onPaper() ? PRINTED : box.clientWidth);
