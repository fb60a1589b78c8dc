// What a sample is made of: colour and extinction of its value.

#import transfer_{transfer}

fn material_of(value: Sample) -> Classified {
    return classify(value);
}
