const PUSHED = 8u;
