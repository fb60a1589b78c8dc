// The tables of all channels in one texture, one below the other.

#import transfer_table

fn classify_channel(channel: u32, value: f32) -> Classified {
    return classified_by(
        value,
        frame.channel_table_first[channel],
        frame.channel_table_scale[channel],
        f32(frame.channel_table_count[channel]) - 1.0,
        frame.channel_table_row[channel],
    );
}
