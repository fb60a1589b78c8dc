// Which pixel an invocation draws. Drivers on CPUs put eight invocations that follow each other along x to work side by
// side: here they have a block of 4 x 2 pixels, whose rays are nearer to one another than those of a row of eight.

fn pixel_of(invocation: vec2<u32>) -> vec2<u32> {
    let own = invocation & vec2(7u);
    return (invocation - own) + vec2((own.x & 3u) + 4u * (own.y & 1u), (own.x >> 2u) + (own.y & 6u));
}
