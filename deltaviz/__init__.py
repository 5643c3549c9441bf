"""deltaviz: a 3D viewer and jog controller for delta robots in the browser."""




