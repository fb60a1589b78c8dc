const PUSHED = 16u;
