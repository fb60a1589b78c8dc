//! The attributes that we look at, by the data dictionary of DICOM PS3.6. All others are passed over unread.

macro_rules! tags {
    ($($name:ident = $tag:literal $keyword:literal;)*) => {
        $(pub(super) const $name: u32 = $tag;)*

        /// The dictionary's keyword of an attribute that we keep; `None` for all others.
        pub(super) fn keyword(tag: u32) -> Option<&'static str> {
            match tag {
                $($name => Some($keyword),)*
                _ => None,
            }
        }
    };
}

tags! {
    MEDIA_STORAGE_SOP_CLASS_UID = 0x0002_0002 "MediaStorageSOPClassUID";
    TRANSFER_SYNTAX_UID = 0x0002_0010 "TransferSyntaxUID";
    SOP_CLASS_UID = 0x0008_0016 "SOPClassUID";
    SOP_INSTANCE_UID = 0x0008_0018 "SOPInstanceUID";
    ACQUISITION_DATE = 0x0008_0022 "AcquisitionDate";
    ACQUISITION_DATE_TIME = 0x0008_002a "AcquisitionDateTime";
    ACQUISITION_TIME = 0x0008_0032 "AcquisitionTime";
    MODALITY = 0x0008_0060 "Modality";
    SERIES_DESCRIPTION = 0x0008_103e "SeriesDescription";
    SLICE_THICKNESS = 0x0018_0050 "SliceThickness";
    ECHO_TIME = 0x0018_0081 "EchoTime";
    SPACING_BETWEEN_SLICES = 0x0018_0088 "SpacingBetweenSlices";
    TRIGGER_TIME = 0x0018_1060 "TriggerTime";
    FRAME_TIME = 0x0018_1063 "FrameTime";
    FRAME_TIME_VECTOR = 0x0018_1065 "FrameTimeVector";
    IMAGER_PIXEL_SPACING = 0x0018_1164 "ImagerPixelSpacing";
    EFFECTIVE_ECHO_TIME = 0x0018_9082 "EffectiveEchoTime";
    DIFFUSION_B_VALUE = 0x0018_9087 "DiffusionBValue";
    CARDIAC_SYNCHRONIZATION = 0x0018_9118 "CardiacSynchronizationSequence";
    NOMINAL_CARDIAC_TRIGGER_DELAY = 0x0020_9153 "NominalCardiacTriggerDelayTime";
    MR_ECHO = 0x0018_9114 "MREchoSequence";
    MR_DIFFUSION = 0x0018_9117 "MRDiffusionSequence";
    SERIES_INSTANCE_UID = 0x0020_000e "SeriesInstanceUID";
    INSTANCE_NUMBER = 0x0020_0013 "InstanceNumber";
    IMAGE_POSITION = 0x0020_0032 "ImagePositionPatient";
    IMAGE_ORIENTATION = 0x0020_0037 "ImageOrientationPatient";
    TEMPORAL_POSITION = 0x0020_0100 "TemporalPositionIdentifier";
    FRAME_ACQUISITION_DATE_TIME = 0x0018_9074 "FrameAcquisitionDateTime";
    FRAME_CONTENT = 0x0020_9111 "FrameContentSequence";
    PLANE_POSITION = 0x0020_9113 "PlanePositionSequence";
    PLANE_ORIENTATION = 0x0020_9116 "PlaneOrientationSequence";
    TEMPORAL_POSITION_INDEX = 0x0020_9128 "TemporalPositionIndex";
    SAMPLES_PER_PIXEL = 0x0028_0002 "SamplesPerPixel";
    PHOTOMETRIC_INTERPRETATION = 0x0028_0004 "PhotometricInterpretation";
    PLANAR_CONFIGURATION = 0x0028_0006 "PlanarConfiguration";
    NUMBER_OF_FRAMES = 0x0028_0008 "NumberOfFrames";
    FRAME_INCREMENT_POINTER = 0x0028_0009 "FrameIncrementPointer";
    ROWS = 0x0028_0010 "Rows";
    COLUMNS = 0x0028_0011 "Columns";
    PIXEL_SPACING = 0x0028_0030 "PixelSpacing";
    BITS_ALLOCATED = 0x0028_0100 "BitsAllocated";
    BITS_STORED = 0x0028_0101 "BitsStored";
    HIGH_BIT = 0x0028_0102 "HighBit";
    PIXEL_REPRESENTATION = 0x0028_0103 "PixelRepresentation";
    PIXEL_PADDING_VALUE = 0x0028_0120 "PixelPaddingValue";
    PIXEL_PADDING_RANGE_LIMIT = 0x0028_0121 "PixelPaddingRangeLimit";
    RESCALE_INTERCEPT = 0x0028_1052 "RescaleIntercept";
    RESCALE_SLOPE = 0x0028_1053 "RescaleSlope";
    RESCALE_TYPE = 0x0028_1054 "RescaleType";
    MODALITY_LUT = 0x0028_3000 "ModalityLUTSequence";
    PIXEL_MEASURES = 0x0028_9110 "PixelMeasuresSequence";
    PIXEL_VALUE_TRANSFORMATION = 0x0028_9145 "PixelValueTransformationSequence";
    DETECTOR_INFORMATION = 0x0054_0022 "DetectorInformationSequence";
    UNITS = 0x0054_1001 "Units";
    SEGMENT_IDENTIFICATION = 0x0062_000a "SegmentIdentificationSequence";
    REFERENCED_SEGMENT_NUMBER = 0x0062_000b "ReferencedSegmentNumber";
    SEGMENTATION_TYPE = 0x0062_0001 "SegmentationType";
    DOSE_UNITS = 0x3004_0002 "DoseUnits";
    GRID_FRAME_OFFSET_VECTOR = 0x3004_000c "GridFrameOffsetVector";
    DOSE_GRID_SCALING = 0x3004_000e "DoseGridScaling";
    SHARED_FUNCTIONAL_GROUPS = 0x5200_9229 "SharedFunctionalGroupsSequence";
    PER_FRAME_FUNCTIONAL_GROUPS = 0x5200_9230 "PerFrameFunctionalGroupsSequence";
    EXTENDED_OFFSET_TABLE = 0x7fe0_0001 "ExtendedOffsetTable";
    FLOAT_PIXEL_DATA = 0x7fe0_0008 "FloatPixelData";
    DOUBLE_FLOAT_PIXEL_DATA = 0x7fe0_0009 "DoubleFloatPixelData";
    PIXEL_DATA = 0x7fe0_0010 "PixelData";
}

pub(super) const ITEM: u32 = 0xfffe_e000;
pub(super) const ITEM_END: u32 = 0xfffe_e00d;
pub(super) const SEQUENCE_END: u32 = 0xfffe_e0dd;

/// True where the value is a list of data sets. An implicit file does not say so.
pub(super) fn is_sequence(tag: u32) -> bool {
    matches!(
        tag,
        MR_ECHO
            | MR_DIFFUSION
            | FRAME_CONTENT
            | PLANE_POSITION
            | PLANE_ORIENTATION
            | MODALITY_LUT
            | PIXEL_MEASURES
            | PIXEL_VALUE_TRANSFORMATION
            | DETECTOR_INFORMATION
            | SEGMENT_IDENTIFICATION
            | CARDIAC_SYNCHRONIZATION
            | SHARED_FUNCTIONAL_GROUPS
            | PER_FRAME_FUNCTIONAL_GROUPS
    )
}

/// `(0028,0010) Rows`, as errors name an attribute.
pub(super) fn name(tag: u32) -> String {
    let [a, b, c, d] = tag.to_be_bytes();
    let number = format!("({a:02x}{b:02x},{c:02x}{d:02x})");
    match keyword(tag) {
        Some(keyword) => format!("{keyword} {number}"),
        None => number,
    }
}
